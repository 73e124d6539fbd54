"""Draws the building without cues, with each and with all into docs/pictures/looks/, for looks.md.

python docs/make_look_pictures.py
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image

from seethrough.experiment.gallery.gallery_looks import looks
from seethrough.experiment.gallery.gallery_plates import DYNAMIC
from seethrough.experiment.gallery.gallery_scenes import views
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed

SIZE = (1200, 900)
OUT = Path(__file__).parent / "pictures" / "looks"


def main() -> None:
    """Write all of them."""
    OUT.mkdir(exist_ok=True)
    renderer = Renderer(standalone(), SIZE)
    scene, camera = views(SIZE[0] / SIZE[1], 1)["walkthrough"]
    for name, look in looks("walkthrough").items():
        renderer.draw(dressed(scene, look), camera, DYNAMIC)
        Image.fromarray(renderer.read()).save(OUT / f"{name}.png", optimize=True)
        print(OUT / f"{name}.png")


if __name__ == "__main__":
    main()
