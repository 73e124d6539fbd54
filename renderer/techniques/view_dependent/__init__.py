"""View-dependent transparency: what faces the viewer is the clearest."""

from seethrough.renderer.techniques.view_dependent.view_dependent import TECHNIQUE

__all__ = ["TECHNIQUE"]
