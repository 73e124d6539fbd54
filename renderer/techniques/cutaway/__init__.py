"""Cut-away: what lies before planes about a target is removed."""

from seethrough.renderer.techniques.cutaway.cutaway import TECHNIQUE

__all__ = ["TECHNIQUE"]
