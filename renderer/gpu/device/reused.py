"""Textures and buffers that one frame leaves to the next, and a switch that makes that loud.

Whoever makes one that frames fill anew says so (`kept`). What of it a frame reads without having
drawn it there shows only when the frame before left something that matters: with `LOUD`, which
tests turn on, all of it is filled with numbers that nothing can swallow before each frame.
"""

from __future__ import annotations

from typing import TypeVar
from weakref import WeakSet

import moderngl
import numpy as np

LOUD = False  # tests alone turn this on
NEAREST = 0.0  # depth: in front of all that is drawn

Thing = TypeVar("Thing", moderngl.Texture, moderngl.Renderbuffer, moderngl.Buffer)
_kept: WeakSet[moderngl.Texture | moderngl.Renderbuffer | moderngl.Buffer] = WeakSet()


def kept(thing: Thing) -> Thing:
    """A texture or buffer that frames fill anew and nobody reads between them."""
    _kept.add(thing)
    return thing


def begin(context: moderngl.Context) -> None:
    """A frame begins: nothing that the last one left in this context may be read."""
    if LOUD:
        spoil(*(thing for thing in _kept if thing.ctx.mglo is context.mglo))


def spoil(*things: moderngl.Texture | moderngl.Renderbuffer | moderngl.Buffer | None) -> None:
    """Fill things that somebody begins to fill anew; no effect unless LOUD."""
    if not LOUD:
        return
    for thing in things:
        if thing is None or isinstance(thing.mglo, moderngl.InvalidObject):
            continue
        if isinstance(thing, moderngl.Buffer):
            # As a float not a number, as a whole number more than there is of anything.
            thing.write(np.full(thing.size // 4, np.nan, np.float32).tobytes())
            continue
        pictures = [] if thing.depth else [thing]
        framebuffer = thing.ctx.framebuffer(pictures, thing if thing.depth else None)
        framebuffer.clear(np.nan, np.nan, np.nan, np.nan, depth=NEAREST)
        framebuffer.release()
