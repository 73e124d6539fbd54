"""Fading about the pointer."""

from seethrough.renderer.techniques.fade.fade import TECHNIQUE

__all__ = ["TECHNIQUE"]
