"""`seethrough render`: draw a scene into a picture, without a window."""

from __future__ import annotations

import argparse
import re
import tomllib
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import TypeVar

import numpy as np

from seethrough import registry
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.outputs import check_output
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.meant import meant, one_of
from seethrough.renderer.plan.explain import explain
from seethrough.renderer.plan.frame_plan import SHORTCUTS
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.look import PLAIN, Look
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Parameters
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.tasks.kit.controls import orbit, walk
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

Given = TypeVar("Given", Parameters, Look)

HELP = "draw a scene into a picture"


def abstract(seed: int, aspect: float) -> tuple[Scene, Camera]:
    """A world of the counting task, from where its trial begins."""
    parameters = AbstractParameters()
    scene = abstract_scene(np.random.default_rng(seed), parameters)
    return scene, orbit(parameters, aspect).camera()


def walkthrough(seed: int, aspect: float) -> tuple[Scene, Camera]:
    """A building of the search task, from where its trial begins."""
    parameters = BuildingParameters()
    building = unique_building(np.random.default_rng(seed), parameters)
    return building.scene, walk(parameters, building.start).camera()


def models(seed: int, aspect: float) -> tuple[Scene, Camera]:
    """Every model of the library once: the contact sheet, the same for every seed."""
    from seethrough.renderer.models.sheet import contact_sheet_scene

    return contact_sheet_scene(aspect)


def jeep(seed: int, aspect: float) -> tuple[Scene, Camera]:
    """The jeep with its inner parts as targets, the same for every seed."""
    from seethrough.renderer.models.vehicles.jeep import jeep_scene

    return jeep_scene(), look_at(np.array([2.2, 1.5, -2.6]), np.array([0.0, 0.42, 0.0]), fov_y=0.47)


SCENES: dict[str, Callable[[int, float], tuple[Scene, Camera]]] = {
    "abstract": abstract,
    "jeep": jeep,
    "models": models,
    "walkthrough": walkthrough,
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument(
        "scene", metavar="SCENE|STUDY",
        help=f"what to draw: {', '.join(sorted(SCENES))}, or each cell of a study",
    )  # fmt: skip
    parser.add_argument(
        "--technique", choices=registry.known("technique"),
        help="dynamic transparency unless another is named",
    )  # fmt: skip
    parser.add_argument("--out", required=True, type=Path, help="the picture, a .png file")
    parser.add_argument("--size", default="800x600", help="WIDTHxHEIGHT in pixels")
    parser.add_argument("--seed", type=int, default=1, help="of the scene, ≥ 0")
    parser.add_argument("--samples", type=int, default=0, help="for antialiasing, 0 to 16")
    parser.add_argument(
        "--set",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help="a parameter of the technique, as mask=circle (may be given again)",
    )
    parser.add_argument(
        "--look",
        metavar="KEY=VALUE",
        action="append",
        default=[],
        help="a key of a study's [look], as fog=40 (may be given again)",
    )
    parser.add_argument(
        "--explain", action="store_true", help="print what the frame needs, and why"
    )
    parser.add_argument(
        "--without",
        metavar="SHORTCUT",
        action="append",
        default=[],
        help=f"a shortcut not to take (may be given again): {', '.join(SHORTCUTS)}",
    )


def run(args: argparse.Namespace) -> int:
    """Draw, write the picture, and say in a line what the frame took."""
    size = _size(args.size)
    out = _writable(args.out)
    if args.seed < 0:
        raise InputError(f"--seed = {args.seed}: expected a number ≥ 0")
    if not 0 <= args.samples <= 16:
        raise InputError(f"--samples = {args.samples}: expected a number from 0 to 16")
    if args.scene not in SCENES:
        return _study(args, size, out)
    from PIL import Image

    from seethrough.renderer.gpu.device.context import standalone
    from seethrough.renderer.gpu.renderer import Renderer

    scene, camera = SCENES[args.scene](args.seed, size[0] / size[1])
    own = named(args.technique) if args.technique else DynamicTransparency()
    technique = _given("set", own, args.set)
    scene = dressed(scene, _given("look", PLAIN, args.look))
    unknown = sorted(set(args.without) - set(SHORTCUTS))
    if unknown:
        raise InputError(f"--without = {unknown[0]}: expected {one_of(unknown[0], SHORTCUTS)}")
    try:
        renderer = Renderer(standalone(), size, args.samples, frozenset(args.without))
    except RuntimeError as error:
        raise InputError(str(error)) from error
    stats = renderer.draw(scene, camera, technique)
    Image.fromarray(renderer.read()).save(out)
    print(
        f"{out}: {len(scene.objects)} objects, {stats.passes} passes, {stats.draws} draws, "
        f"{stats.masks} masks, {stats.ordered} objects put in order"
    )
    if args.explain and renderer.plan is not None:
        print("\n".join(explain(scene, renderer.plan)))
    return 0


def _study(args: argparse.Namespace, size: tuple[int, int], out: Path) -> int:
    """A plate of each cell of a study, with the study's own techniques."""
    from seethrough.experiment.display.driver import open_context
    from seethrough.experiment.gallery.study_plates import first_trials, plates
    from seethrough.experiment.study.config import load

    if args.set or args.without or args.look:
        raise InputError("--set, --look and --without: expected with a scene; a study has its own")
    study = load(args.scene)
    try:
        plates(study, open_context(), size, args.samples).save(out)
    except ValueError as error:
        raise InputError(f"{args.scene}: {error}") from None
    print(f"{out}: {len(first_trials(study))} plates of {study.general.name}")
    return 0


def _given(option: str, base: Given, settings: list[str]) -> Given:
    """Parameters with `settings` ("key=value", values as in TOML or bare words)."""
    values: dict[str, object] = {}
    known = {field.name for field in fields(base)}
    for text in settings:
        key, equals, value = text.partition("=")
        if not equals or key not in known:
            wanted = ", ".join(sorted(known)) or "none, it has no parameters"
            raise InputError(
                f"--{option} = {text}: expected KEY=VALUE with one of {wanted}" + meant(key, known)
            )
        try:
            found = tomllib.loads(f"value = {value}")["value"]
            values[key] = tuple(found) if isinstance(found, list) else found
        except tomllib.TOMLDecodeError:
            values[key] = value
    try:
        return type(base)(**{name: getattr(base, name) for name in known} | values)
    except (TypeError, ValueError) as error:
        raise InputError(f"--{option}: {error}") from error


def _size(text: str) -> tuple[int, int]:
    found = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    size = (int(found[1]), int(found[2])) if found else (0, 0)
    if not all(1 <= s <= 8192 for s in size):
        raise InputError(f"--size = {text}: expected WIDTHxHEIGHT, each from 1 to 8192, as 800x600")
    return size


def _writable(out: Path) -> Path:
    check_output("--out", out, ".png")
    return out
