"""Magic lens: what stands in a volume under the pointer is removed."""

from seethrough.renderer.techniques.lens.lens import TECHNIQUE

__all__ = ["TECHNIQUE"]
