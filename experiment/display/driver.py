"""Names of the graphics driver, for records."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError

if TYPE_CHECKING:
    from moderngl import Context

SOFTWARE = ("llvmpipe", "softpipe", "swiftshader", "software")  # rasterisers on the processor
INSTEAD = "`seethrough simulate` plays a study, `seethrough render` draws"
THREADS = "LP_NUM_THREADS"  # environment variable of Mesa's llvmpipe
AUTOMATIC = 4  # samples where a graphics card draws


def describe(context: Context) -> Mapping[str, str]:
    """Vendor, renderer and version of a context's OpenGL."""
    info = context.info
    return {
        "vendor": info["GL_VENDOR"],
        "renderer": info["GL_RENDERER"],
        "opengl": info["GL_VERSION"],
    }


def samples_for(wanted: str | int, context: Context) -> int:
    """Samples a pixel: as the study says, or by what draws. 4 × costs a software rasteriser some
    20 ms a frame at 800 × 600, a graphics card next to nothing."""
    if isinstance(wanted, int):
        return wanted
    return 0 if on_the_processor(context) else AUTOMATIC


def on_the_processor(context: Context) -> bool:
    """Whether a software rasteriser draws."""
    renderer = context.info["GL_RENDERER"].lower()
    return any(name in renderer for name in SOFTWARE)


def open_context(looks: bool = False) -> Context:
    """A context without a window. Raises InputError, one line, where there is no OpenGL.

    `looks`: for pictures so small that a software rasteriser is done sooner alone than with threads
    that it has to wake. A process's first context decides.
    """
    from seethrough.renderer.gpu.device.context import (
        standalone,
    )  # here: who only names drivers needs no OpenGL

    with _alone() if looks else nullcontext():
        try:
            return standalone()
        except RuntimeError as error:
            raise InputError(str(error)) from None


@contextmanager
def _alone() -> Iterator[None]:
    """What is opened here rasterises without threads of its own (Mesa), unless the user says."""
    if THREADS in os.environ:
        yield
        return
    os.environ[THREADS] = "0"
    try:
        yield
    finally:
        del os.environ[THREADS]


def no_window(error: Exception, instead: str = INSTEAD) -> InputError:
    """What to say, and to do instead, where no window can be opened."""
    said = " ".join(str(error).split())
    if sys.platform.startswith("linux") and not os.environ.get("DISPLAY"):
        said = "DISPLAY is not set"
    return InputError(
        f"display: no window can be opened ({said}); expected to be started from a terminal on a "
        f"desktop; without one, {instead}"
    )


def window_context() -> Context:
    """The context of the window that was opened last. Raises InputError, one line, without one."""
    import moderngl

    try:
        return moderngl.create_context(require=330)
    except Exception as error:  # glcontext raises bare Exception
        said = str(error).strip().partition("\n")[0]
        raise InputError(
            f"display: OpenGL 3.3 is not available in a window ({said}), expected a graphics driver"
        ) from None
