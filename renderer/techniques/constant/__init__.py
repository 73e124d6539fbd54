"""Constant transparency: everything in the way is equally transparent."""

from seethrough.renderer.techniques.constant.constant import TECHNIQUE

__all__ = ["TECHNIQUE"]
