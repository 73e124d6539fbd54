"""`seethrough gallery`: every technique, parameter, look and hard case as a page of pictures."""

from __future__ import annotations

import argparse
import html
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.gallery.gallery_plates import SIZE, Plate, Section
from seethrough.experiment.gallery.gallery_scenes import sections

if TYPE_CHECKING:
    from seethrough.renderer.gpu.renderer import Renderer

HELP = "draw every technique, parameter, look and hard case into a page"
WIDEST = 1200  # pixels of a picture on the page

_PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>Seethrough: gallery</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<style>
body {{ font: 15px/1.4 system-ui, sans-serif; margin: 2rem auto; max-width: 90rem; padding: 0 1rem;
  color: #222; background: #fff; }}
h2 {{ margin: 2.5rem 0 .25rem; }} section > p {{ margin: 0 0 .75rem; }}
.plates {{ display: grid; gap: 1rem; grid-template-columns: repeat(auto-fill, minmax(19rem, 1fr)) }}
.many {{ gap: .5rem; grid-template-columns: repeat(auto-fill, minmax(9.5rem, 1fr)) }}
.many figcaption {{ font-size: .8rem; }}
figure {{ margin: 0; }} figcaption {{ color: #555; }}
img {{ width: 100%; aspect-ratio: 4 / 3; object-fit: contain; background: #f4f4f4;
  border-radius: 4px; image-rendering: auto; }}
img.small {{ image-rendering: pixelated; }}
dt {{ font-weight: 600; }} dd {{ margin: 0 0 .5rem; font-family: ui-monospace, monospace; }}
</style>
<h1>What the renderer draws</h1>
<p>Made by <code>seethrough gallery</code>. Targets show through whatever stands before them.</p>
<main>
{sections}
</main></html>
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("--out", required=True, type=Path, help="a folder for page and pictures")
    parser.add_argument("--seed", type=int, default=1, help="of the abstract world, ≥ 0")


def run(args: argparse.Namespace) -> int:
    """Draw all plates, write index.html, print where it is."""
    if args.seed < 0:
        raise InputError(f"--seed = {args.seed}: expected a number ≥ 0")
    if args.out.exists() and not args.out.is_dir():
        raise InputError(f"--out = {args.out}: expected a folder")
    from seethrough.renderer.gpu.device.context import standalone
    from seethrough.renderer.gpu.renderer import Renderer

    args.out.mkdir(parents=True, exist_ok=True)
    try:
        renderer = Renderer(standalone(), SIZE, samples=4)
    except RuntimeError as error:
        raise InputError(str(error)) from error
    texts, count = [], 0
    for section in sections(SIZE[0] / SIZE[1], args.seed):
        for plate in section.plates:
            draw(renderer, plate, args.out / f"{plate.name}.png")
        count += len(section.plates)
        texts.append(_section(section))
    page = args.out / "index.html"
    page.write_text(_PAGE.format(sections="\n".join(texts)), "utf-8")
    print(f"{page}: {count} pictures")
    return 0


def draw(renderer: Renderer, plate: Plate, path: Path) -> None:
    """Write one picture, no larger than the page shows it."""
    from PIL import Image

    renderer.resize(plate.size)
    renderer.draw(plate.scene, plate.camera, plate.technique, state=plate.state)
    picture = Image.fromarray(renderer.read())
    picture.thumbnail((WIDEST, WIDEST))
    picture.save(path, optimize=True)


def _section(section: Section) -> str:
    lines = [f"<section><h2>{html.escape(section.title)}</h2>"]
    if section.about:
        lines.append(f"<p>{html.escape(section.about)}</p>")
    if section.plates:
        kind = "plates many" if section.small else "plates"
        lines += [f'<div class="{kind}">', *map(_figure, section.plates), "</div>"]
    if section.refused:
        items = (f"<dt>{html.escape(a)}</dt><dd>{html.escape(b)}</dd>" for a, b in section.refused)
        lines += ["<dl>", *items, "</dl>"]
    return "\n".join([*lines, "</section>"])


def _figure(plate: Plate) -> str:
    caption = html.escape(plate.caption)
    small = ' class="small"' if min(plate.size) < 100 else ""
    return (
        f'<figure><img src="{plate.name}.png" alt="{caption}" loading="lazy"{small}>'
        f"<figcaption>{caption}</figcaption></figure>"
    )
