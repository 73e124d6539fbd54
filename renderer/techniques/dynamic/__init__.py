"""Dynamic transparency."""

from seethrough.renderer.techniques.dynamic.technique import TECHNIQUE

__all__ = ["TECHNIQUE"]
