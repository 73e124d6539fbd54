"""One OpenGL context for all picture tests."""

from __future__ import annotations

import pytest

from seethrough.renderer.gpu.device.context import standalone


@pytest.fixture(scope="session")
def context():
    return standalone()
