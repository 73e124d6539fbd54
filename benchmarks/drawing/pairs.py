"""Pairs of pictures to ask somebody about: which of two things behind walls is nearer, A or B?

`python -m seethrough.benchmarks.drawing.pairs make PICTURES TRUTH.json` draws twenty pairs into a
folder, each twice: without cues of depth and contact, and with all of them. In half of the pairs
walls are transparent about the things alone (dynamic transparency), in half everywhere; in half of
each things stand on the floor, in half they float. How large a thing looks says nothing of its
distance. Names say nothing either; the other file says which picture is of which pair, and which
thing is nearer. `… pairs count TRUTH.json ANSWERS.json` counts the answers, {name: "A" or "B"}.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from seethrough.experiment.gallery.gallery_looks import looks
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.models import MODELS
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import placed, rotation_y
from seethrough.renderer.techniques import named
from seethrough.tasks.kit.controls import walk
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

SIZE = (800, 600)
PAIRS, SEED = 20, 20
NEAR, FAR = 9.0, 34.0  # world units from the eye
RATIO = (1.15, 1.6)  # of the two distances
LARGE = (26.0, 44.0)  # pixels that a thing's radius looks
HIGH = 2.2  # world units that a floating thing's lowest point is above the floor, at most
SIDE = 0.8  # of half the view: where things may be
APART = 60.0  # pixels between the spheres about the two
SHOWN = 250  # pixels of each that have to be seen
TRIES = 4000
WAYS = ("dynamic", "see_through")
PAPER, INK = (255, 255, 255), (20, 20, 20)


@dataclass(frozen=True)
class Pair:
    """Two things, the last of the scene's, left and right; `far` (2,) from the eye."""

    scene: Scene
    camera: Camera
    far: NDArray[np.float64]
    way: str
    floating: bool


def pair(rng: Generator, renderer: Renderer, way: str, floating: bool) -> Pair:
    """Two things behind walls, at random. Raises ValueError if none were found."""
    p = BuildingParameters()
    for _ in range(TRIES):
        building = unique_building(rng, p)
        walls = tuple(o for o in building.scene.objects if not o.target)
        view = walk(p, building.start, rng.uniform(0, 2 * np.pi)).camera()
        for _ in range(20):
            things, far = _two(rng, view, p, floating)
            scene = Scene((*walls, *things), building.scene.background)
            if _placed(scene, view) and _hidden(renderer, scene, view, way):
                return Pair(scene, view, far, way, floating)
    raise ValueError(f"no pair in {TRIES} buildings: expected one")


def _two(
    rng: Generator, camera: Camera, p: BuildingParameters, floating: bool
) -> tuple[list[Object], NDArray[np.float64]]:
    """Two things of other models, the left one first, and how far they are from the eye."""
    ratio = rng.uniform(*RATIO)
    nearer = rng.uniform(NEAR, FAR / ratio)
    far = rng.permutation([nearer, nearer * ratio])
    half = SIDE * SIZE[0] / SIZE[1] * np.tan(camera.fov_y / 2)
    across = np.sort(rng.uniform(-half, half, 2))
    names = rng.choice(sorted(MODELS), 2, replace=False)
    things = []
    for name, x, distance in zip(names.tolist(), across, far, strict=True):
        mesh = MODELS[name]()
        radius = rng.uniform(*LARGE) * distance / camera.lens(SIZE[1])
        way = camera.forward + x * camera.rotation[:, 0]
        spot = camera.eye + distance * way / np.linalg.norm(way)
        lift = rng.uniform(0, HIGH) if floating else 0.0
        turn = rotation_y(rng.uniform(0, 2 * np.pi))
        matrix = placed((spot[0], lift, spot[2]), turn, radius / mesh.radius)
        things.append(Object(mesh, matrix, target=True, kind=name))
    return things, far


def _placed(scene: Scene, camera: Camera) -> bool:
    """Whether the two stand free of each other, of walls, and inside the building."""
    low, high = scene.corners.min(axis=1), scene.corners.max(axis=1)
    kinds = np.array([thing.kind for thing in scene.objects])
    floors = kinds == "floor"
    for k in (-2, -1):
        meets = ((low[k] < high[:-2]) & (low[:-2] < high[k]))[:, [0, 2]].all(axis=1)
        if (meets & ~floors[:-2]).any():
            return False
        if not ((low[floors] < low[k]) & (high[k] < high[floors]))[:, [0, 2]].all():
            return False
    at = camera.places(scene.centers[-2:]) * SIZE[1] / 2
    wide = scene.radii[-2:] / camera.depth(scene.centers[-2:]) * camera.lens(SIZE[1])
    return bool(np.linalg.norm(at[1] - at[0]) > wide.sum() + APART)


def _hidden(renderer: Renderer, scene: Scene, camera: Camera, way: str) -> bool:
    """Whether nothing of the two is seen among opaque walls, and enough with the technique."""
    if renderer.look(scene, camera, named("standard"), SIZE).pixels[-2:].any():
        return False
    return bool((renderer.look(scene, camera, named(way), SIZE).pixels[-2:] >= SHOWN).all())


def pairs(renderer: Renderer, seed: int = SEED) -> list[Pair]:
    """All of them: each way as often, and each with things that stand as often as float."""
    streams = np.random.default_rng(seed).spawn(PAIRS)
    return [pair(rng, renderer, WAYS[k % 2], floating=k % 4 >= 2) for k, rng in enumerate(streams)]


def make(folder: Path, truth: Path, seed: int = SEED) -> None:
    """Draw the pictures, and write which thing is nearer in each."""
    folder.mkdir(parents=True, exist_ok=True)
    renderer = Renderer(standalone(), SIZE)
    found = pairs(renderer, seed)
    rng = np.random.default_rng([seed, 1])
    left_is_a = rng.permutation(np.arange(PAIRS) % 2 == 0)
    names = iter(rng.permutation(2 * PAIRS).tolist())
    every = looks("walkthrough")
    told = {}
    for k, one in enumerate(found):
        letters = "AB" if left_is_a[k] else "BA"
        for cues, look in (("without", every["none"]), ("with", every["all"])):
            renderer.draw(dressed(one.scene, look), one.camera, named(one.way))
            picture = Image.fromarray(renderer.read())
            _mark(picture, one, letters)
            name = f"{next(names) + 1:02d}.png"
            picture.save(folder / name, optimize=True)
            told[name] = {
                "pair": k + 1,
                "cues": cues,
                "technique": one.way,
                "things": "floating" if one.floating else "standing",
                "nearer": letters[int(one.far.argmin())],
                "distances": dict(zip(letters, np.round(one.far, 2).tolist(), strict=True)),
            }
    truth.write_text(json.dumps(dict(sorted(told.items())), indent=1) + "\n", "utf-8")


def _mark(picture: Image.Image, one: Pair, letters: str) -> None:
    """A letter above each thing."""
    draw, font = ImageDraw.Draw(picture), ImageFont.load_default(22)
    wide, high = SIZE
    at = one.camera.places(one.scene.centers[-2:]) * high / 2
    reach = one.scene.radii[-2:] / one.camera.depth(one.scene.centers[-2:])
    for letter, (x, y), radius in zip(letters, at, reach * one.camera.lens(high), strict=True):
        middle = (wide / 2 + x, high / 2 - y - radius - 24)
        box = (middle[0] - 14, middle[1] - 14, middle[0] + 14, middle[1] + 14)
        draw.rounded_rectangle(box, 6, fill=PAPER, outline=INK, width=2)
        draw.text(middle, letter, fill=INK, font=font, anchor="mm")


def counted(truth: dict[str, dict[str, object]], answers: dict[str, str]) -> list[str]:
    """A line for each kind of picture: how many answers are right. Names may go without ".png".
    Raises ValueError where an answer is missing or is neither A nor B."""
    answers = {Path(name).stem + ".png": said for name, said in answers.items()}
    bad = [name for name in truth if answers.get(name) not in ("A", "B")]
    if bad:
        raise ValueError(f"answers to {', '.join(bad)}: expected A or B")
    lines = []
    for key in ("cues", "technique", "things"):
        for value in dict.fromkeys(str(told[key]) for told in truth.values()):
            for cues in ("without", "with"):
                which = [n for n, t in truth.items() if t["cues"] == cues and t[key] == value]
                right = sum(answers[n] == truth[n]["nearer"] for n in which)
                if which:
                    what = "all" if key == "cues" else f"{key} {value}"
                    lines.append(f"{what}, {cues} cues: {right} of {len(which)} right")
    return lines


def main(arguments: Sequence[str] | None = None) -> None:
    """Make pictures, or count answers."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("what", choices=("make", "count"))
    parser.add_argument("first", type=Path, help="make: the pictures' folder; count: the truth")
    parser.add_argument("second", type=Path, help="make: the truth; count: the answers")
    args = parser.parse_args(arguments)
    if args.what == "make":
        make(args.first, args.second)
    else:
        try:
            told, said = (json.loads(path.read_text("utf-8")) for path in (args.first, args.second))
            print("\n".join(counted(told, said)))
        except (OSError, ValueError) as error:
            parser.error(str(error))


if __name__ == "__main__":
    main()
