"""Adaptive cut-away: a cone opens before each target."""

from seethrough.renderer.techniques.adaptive_cutaway.adaptive_cutaway import TECHNIQUE

__all__ = ["TECHNIQUE"]
