"""Importance-driven transparency: what hides something important grows sparse."""

from seethrough.renderer.techniques.importance.importance import TECHNIQUE

__all__ = ["TECHNIQUE"]
