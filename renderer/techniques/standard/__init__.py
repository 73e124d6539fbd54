"""The depth buffer alone."""

from seethrough.renderer.techniques.standard.opaque import TECHNIQUE

__all__ = ["TECHNIQUE"]
