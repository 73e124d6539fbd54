"""Blueprints: the edges of every layer over a faint fill."""

from seethrough.renderer.techniques.blueprint.blueprint import TECHNIQUE

__all__ = ["TECHNIQUE"]
