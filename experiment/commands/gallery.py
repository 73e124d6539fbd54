"""`seethrough gallery`: every mode, mask, granularity and hard case as a page of pictures."""

from __future__ import annotations

import argparse
import html
from pathlib import Path

from experiment.errors import InputError
from experiment.gallery import plates

HELP = "draw every mode, mask, granularity and hard case into a page"
SIZE = (400, 300)

_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Seethrough: gallery</title>
<style>
body {{ font: 15px/1.4 system-ui, sans-serif; margin: 2rem; color: #222; background: #fff; }}
main {{ display: grid; grid-template-columns: repeat(auto-fill, minmax(20rem, 1fr)); gap: 1rem; }}
figure {{ margin: 0; }} img {{ width: 100%; border-radius: 4px; }} figcaption {{ color: #555; }}
</style>
<h1>What the renderer draws</h1>
<main>
{figures}
</main></html>
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("--out", required=True, type=Path, help="a folder for page and pictures")
    parser.add_argument("--seed", type=int, default=1, help="of the scenes, ≥ 0")


def run(args: argparse.Namespace) -> int:
    """Draw all plates, write index.html, print where it is."""
    if args.seed < 0:
        raise InputError(f"--seed = {args.seed}: expected a number ≥ 0")
    if args.out.exists() and not args.out.is_dir():
        raise InputError(f"--out = {args.out}: expected a folder")
    from PIL import Image

    from renderer.gpu.context import standalone
    from renderer.gpu.renderer import Renderer

    args.out.mkdir(parents=True, exist_ok=True)
    try:
        renderer = Renderer(standalone(), SIZE, samples=4)
    except RuntimeError as error:
        raise InputError(str(error)) from error
    figures = []
    for plate in plates(SIZE[0] / SIZE[1], args.seed):
        renderer.draw(plate.scene, plate.camera, plate.technique)
        Image.fromarray(renderer.read()).save(args.out / f"{plate.name}.png")
        caption = html.escape(plate.caption)
        figures.append(
            f'<figure><img src="{plate.name}.png" alt="{caption}">'
            f"<figcaption>{caption}</figcaption></figure>"
        )
    page = args.out / "index.html"
    page.write_text(_PAGE.format(figures="\n".join(figures)), "utf-8")
    print(f"{page}: {len(figures)} pictures")
    return 0
