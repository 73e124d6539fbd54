"""Break-away: a hole in the shape of each target."""

from seethrough.renderer.techniques.breakaway.breakaway import TECHNIQUE

__all__ = ["TECHNIQUE"]
