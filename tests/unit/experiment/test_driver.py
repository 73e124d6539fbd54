"""How many samples a pixel gets, with how many threads a software rasteriser draws."""

import os
from types import SimpleNamespace

import pytest

from seethrough.experiment.display.driver import THREADS, open_context, samples_for
from seethrough.experiment.errors import InputError
from seethrough.renderer.gpu.device import context as gpu


@pytest.mark.parametrize(
    ("renderer", "samples"),
    [("llvmpipe (LLVM 15.0.6, 256 bits)", 0), ("NVIDIA H100", 4), ("Apple M2", 4)],
)
def test_a_software_rasteriser_is_not_asked_for_antialiasing(renderer, samples):
    context = SimpleNamespace(info={"GL_RENDERER": renderer})
    assert samples_for("auto", context) == samples
    assert samples_for(8, context) == 8


def test_a_machine_without_opengl_is_one_line(monkeypatch):
    def nothing():
        raise RuntimeError("OpenGL 3.3: not available, expected a graphics driver")

    monkeypatch.setattr(gpu, "standalone", nothing)
    with pytest.raises(
        InputError, match=r"^OpenGL 3\.3: not available, expected a graphics driver$"
    ):
        open_context()


@pytest.mark.parametrize(
    ("own", "looks", "during"),
    [(None, True, "0"), (None, False, None), ("2", True, "2"), ("2", False, "2")],
)
def test_looks_are_rasterised_without_threads_unless_the_user_says(monkeypatch, own, looks, during):
    """Said to the driver while the context is opened, and to nobody after."""
    said = []
    if own is None:
        monkeypatch.delenv(THREADS, raising=False)
    else:
        monkeypatch.setenv(THREADS, own)
    monkeypatch.setattr(gpu, "standalone", lambda: said.append(os.environ.get(THREADS)))
    open_context(looks=looks)
    assert said == [during]
    assert os.environ.get(THREADS) == own


def test_a_context_that_cannot_be_opened_leaves_the_threads_alone(monkeypatch):
    def nothing():
        raise RuntimeError("OpenGL 3.3: not available, expected a graphics driver")

    monkeypatch.delenv(THREADS, raising=False)
    monkeypatch.setattr(gpu, "standalone", nothing)
    with pytest.raises(InputError):
        open_context(looks=True)
    assert THREADS not in os.environ
