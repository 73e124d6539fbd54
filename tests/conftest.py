"""One OpenGL context for all picture tests."""

from __future__ import annotations

import pytest

from renderer.gpu.context import standalone


@pytest.fixture(scope="session")
def context():
    return standalone()
