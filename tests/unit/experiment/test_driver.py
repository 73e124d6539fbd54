"""How many samples a pixel gets."""

from types import SimpleNamespace

import pytest

from seethrough.experiment.display.driver import open_context, samples_for
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
