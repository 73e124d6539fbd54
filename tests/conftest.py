"""One OpenGL context for all picture tests."""

from __future__ import annotations

import moderngl
import pytest

from seethrough.renderer.gpu.device.context import standalone


@pytest.fixture(scope="session")
def context():
    made = standalone()
    made.gc_mode = "context_gc"  # what nobody holds any more waits in `objects`
    return made


@pytest.fixture(scope="module", autouse=True)
def current(request):
    """Whoever draws does so in its own context: calls go to whichever was made last, and a module
    before this one may have made one."""
    items = [item for item in request.session.items if item.path == request.path]
    if any("context" in item.fixturenames for item in items):
        request.getfixturevalue("context").__enter__()


@pytest.fixture(autouse=True)
def released(request, current):
    """What a test drew into goes with it: else pictures of all tests add up to gigabytes."""
    yield
    if "context" in request.fixturenames:
        left = request.getfixturevalue("context").objects
        while left:
            thing = left.popleft()
            if not isinstance(thing, moderngl.InvalidObject):
                thing.release()
