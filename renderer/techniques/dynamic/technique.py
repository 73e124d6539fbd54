"""Dynamic transparency as a technique: its rule is exact.py, its painter draws masks by levels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from seethrough.renderer.events import Event, PointerMove
from seethrough.renderer.techniques import base
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.renderer.techniques.pointing import Pointing, followed
from seethrough.renderer.techniques.seen import Look, Surfaces

if TYPE_CHECKING:
    from seethrough.renderer.techniques.dynamic.exact import Mask

Masks: TypeAlias = Mapping[int, "Mask"]  # by target

TEXTS: base.Texts = {
    "en": {
        "dynamic.controls": "Near the pointer, things that stand in the way turn transparent.",
        "dynamic.controls.walking": "In the middle of the view, things that stand in the way "
        "turn transparent.",
    },
    "de": {
        "dynamic.controls": "Nahe beim Zeiger wird durchsichtig, was im Weg steht.",
        "dynamic.controls.walking": "In der Mitte des Bildes wird durchsichtig, was im Weg steht.",
    },
}


class DynamicRendering(base.Plain[DynamicTransparency, Pointing | None, Masks]):
    """What stands before a target turns transparent, by a mask about it."""

    name = "dynamic"
    title = "Dynamic transparency"
    instruction = "Things turn transparent where a target lies behind them."
    source = "Elmqvist2009"
    misses = "meets all of them"
    painter = base.MASKS
    takes = frozenset({"pointer"})
    texts = TEXTS
    Parameters = DynamicTransparency

    def begin(self, p: DynamicTransparency) -> Pointing | None:
        """Where the pointer is, in active mode: nowhere yet, or where the study has it."""
        return Pointing(p.pointer, 0.0) if p.mode == "active" else None

    def on_event(
        self, p: DynamicTransparency, state: Pointing | None, event: Event, shot: base.Shot
    ) -> tuple[Pointing | None, bool]:
        """The pointer carries the searchlight, and others see its moves too."""
        if state is None or not isinstance(event, PointerMove):
            return state, False
        return followed(state, event, 0.0)

    def drawn(self, p: DynamicTransparency, state: Pointing | None) -> DynamicTransparency:
        """With the searchlight where the pointer is."""
        return p if state is None else replace(p, pointer=state.pointer)

    def touches(
        self, p: DynamicTransparency, state: Pointing | None, shot: base.Shot
    ) -> base.Bools:
        """Whatever is not impenetrable, where there is a target."""
        scene = shot.scene
        return np.full(len(scene.objects), bool(scene.targets.any())) & ~scene.impenetrable

    def known(self, p: DynamicTransparency, state: Pointing | None, seen: Surfaces) -> Masks:
        """The masks."""
        from seethrough.renderer.techniques.dynamic import exact

        return exact.known(self.drawn(p, state), seen)

    def rule(
        self, p: DynamicTransparency, state: Pointing | None, seen: Surfaces, known: Masks
    ) -> Look:
        """Opacities of the front-most surface of each object."""
        from seethrough.renderer.techniques.dynamic import exact

        return exact.rule(self.drawn(p, state), seen, known)

    def exactly(self, p: DynamicTransparency) -> DynamicTransparency:
        """Every pixel sorted by itself."""
        return replace(p, exact=True)

    def looked_at(self, p: DynamicTransparency) -> DynamicTransparency:
        """Polygons have no numbers of their objects: what they show is looked for by pixel."""
        return replace(p, order="planes") if p.order == "polygons" else p


TECHNIQUE = DynamicRendering()
