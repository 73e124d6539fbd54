"""Balloon probe: things near the pointer move aside."""

from seethrough.renderer.techniques.balloon.balloon import TECHNIQUE

__all__ = ["TECHNIQUE"]
