"""Scenes that ship, as GLB files made by code: `python -m seethrough.renderer.models.shipped.make`
writes them anew."""
