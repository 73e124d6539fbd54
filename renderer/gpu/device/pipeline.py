"""What a context draws with, where moderngl's own types know less than it takes."""

from __future__ import annotations

from collections.abc import Callable
from ctypes import CFUNCTYPE
from typing import TypeAlias

import moderngl

Factors: TypeAlias = tuple[int, int] | tuple[int, int, int, int]

# What is drawn is colour times opacity, and opacity. Over a picture without opacity of its own;
# under what has been added up so far.
OVER: Factors = (moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA, moderngl.ZERO, moderngl.ONE)
UNDER: Factors = (moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE)
# A frame's own alpha says how strongly the next object will show: objects blend by it, masks are
# multiplied into it. What is opaque takes all; depth alone takes nothing.
OBJECT: Factors = (moderngl.DST_ALPHA, moderngl.ONE_MINUS_DST_ALPHA, moderngl.ZERO, moderngl.ONE)
MASK: Factors = (moderngl.ZERO, moderngl.ONE, moderngl.ZERO, moderngl.SRC_ALPHA)
OPAQUE: Factors = (moderngl.ONE, moderngl.ZERO, moderngl.ONE, moderngl.ZERO)
NOTHING: Factors = (moderngl.ZERO, moderngl.ONE, moderngl.ZERO, moderngl.ONE)


def within(target: moderngl.Framebuffer, box: tuple[int, int, int, int] | None) -> None:
    """Draw only into a box (left, bottom, width, height) of a framebuffer; None: everywhere."""
    target.scissor = box  # type: ignore[assignment]  # takes None, as its documentation says


def blend(context: moderngl.Context, factors: Factors) -> None:
    """Factors of what is drawn and of what is there; two more for alpha where it has its own."""
    context.blend_func = factors  # type: ignore[assignment]  # takes four, as its text says


def combine(context: moderngl.Context, color: int, alpha: int | None = None) -> None:
    """How the two are put together; alpha otherwise if it is given."""
    context.blend_equation = (color, color if alpha is None else alpha)


def flushing(context: moderngl.Context) -> Callable[[], None]:
    """What lets the driver begin with what it was given so far: a software rasteriser then draws
    beside whatever the next draws take to be made. moderngl has no name for glFlush."""
    flush: Callable[[], None] = CFUNCTYPE(None)(
        context.mglo._context.load_opengl_function("glFlush")
    )
    return flush
