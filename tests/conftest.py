"""One OpenGL context for all picture tests."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from seethrough.renderer.gpu.device.context import standalone


@pytest.fixture(scope="session")
def context():
    return standalone()


@pytest.fixture(autouse=True)
def current(request: pytest.FixtureRequest) -> Iterator[None]:
    """A test that draws does so in its own context: calls go to whichever was made last, and
    another test may have made one since."""
    if "context" not in request.fixturenames:
        yield
        return
    with request.getfixturevalue("context"):
        yield
