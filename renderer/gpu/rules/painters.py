"""Which painters draw what a technique's rule is asked about, one after the other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import moderngl

from seethrough.renderer.gpu.rules.lined_painter import LinedPainter
from seethrough.renderer.gpu.rules.list_painter import ListPainter
from seethrough.renderer.gpu.rules.lists import NEEDED
from seethrough.renderer.gpu.rules.order_painter import OrderPainter
from seethrough.renderer.gpu.rules.peel_painter import PeelPainter
from seethrough.renderer.gpu.rules.removal_painter import RemovalPainter
from seethrough.renderer.techniques.base import PEELS, REMOVAL, Parameters

GHOSTS = "ghosts"  # lines of what was removed, over what is left
ORDERED = "ordered"  # polygon by polygon, in the order of a method

LISTS = "lists"  # surfaces that show through one another
LINED = "lined"  # and with lines along their edges

Painter = PeelPainter | RemovalPainter | OrderPainter | ListPainter | LinedPainter


def _where_able(
    made: type[ListPainter | LinedPainter], looked_at: bool
) -> Callable[[moderngl.Context, Sequence[str]], Painter]:
    """In one pass where the context can, else layer by layer; `looked_at`: with ids as well."""

    def make(context: moderngl.Context, defines: Sequence[str]) -> Painter:
        able = context.version_code >= NEEDED and (looked_at or "WITH_IDS" not in defines)
        return made(context, defines) if able else PeelPainter(context, defines)

    return make


PAINTERS: Mapping[str, Callable[..., Painter]] = {
    REMOVAL: RemovalPainter,
    GHOSTS: partial(PeelPainter, ghosts=True),
    ORDERED: OrderPainter,
    LISTS: _where_able(ListPainter, looked_at=True),
    LINED: _where_able(LinedPainter, looked_at=False),
}


def of(technique: Parameters) -> tuple[str, ...]:
    """The names of those that draw with these parameters."""
    rules = technique.technique
    if rules.order(technique) is not None:
        return (ORDERED,)
    if rules.painter == REMOVAL and rules.edges(technique):
        return (REMOVAL, GHOSTS)
    if rules.painter == PEELS:
        return (LINED if rules.edges(technique) else LISTS,)
    return (rules.painter,)
