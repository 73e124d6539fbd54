"""Digging: the viewer digs holes into what is in the way."""

from seethrough.renderer.techniques.dig.dig import TECHNIQUE

__all__ = ["TECHNIQUE"]
