"""See-through surfaces: tagged things, as walls, are transparent."""

from seethrough.renderer.techniques.see_through.see_through import TECHNIQUE

__all__ = ["TECHNIQUE"]
