"""The glTF files that this project writes."""

from __future__ import annotations

import pytest

from seethrough.renderer.models.shipped.glb import BYTE, LONG, SHORT, _index_kind


@pytest.mark.parametrize(
    ("vertices", "kind"),
    [(3, BYTE), (255, BYTE), (256, SHORT), (65535, SHORT), (65536, LONG), (10**6, LONG)],
)
def test_the_largest_number_of_a_kind_is_no_index(vertices, kind):
    """255 would be the last index of 256 vertices, and 65535 of 65536 (glTF 2.0 §3.7.2.1)."""
    assert _index_kind(vertices)[1] == kind
