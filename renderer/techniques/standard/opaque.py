"""Ordinary depth-buffered rendering: what the paper compares dynamic transparency with."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.renderer.techniques import base


@dataclass(frozen=True)
class Standard(base.Parameters):
    """Opaque objects and a depth buffer. It has no parameters."""


class StandardRendering(base.Plain[Standard]):
    """Nothing is touched: the frame is the depth buffer's."""

    name = "standard"
    title = "Standard rendering"
    instruction = "Things hide what lies behind them."
    source = "Elmqvist2009"
    Parameters = Standard


TECHNIQUE = StandardRendering()
