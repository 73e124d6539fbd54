"""Every technique on the same scenes, and where each of them fails."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import fields, replace

import numpy as np

from seethrough import registry
from seethrough.experiment.gallery.gallery_failures import failures
from seethrough.experiment.gallery.gallery_plates import Plate, Section
from seethrough.renderer import events
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques import named
from seethrough.renderer.techniques.base import Parameters, Shot
from seethrough.tasks.kit.controls import orbit
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene

POINTER = (0.62, 0.5)  # at the horse of the stage


def sections(stage: tuple[Scene, Camera], aspect: float, seed: int) -> Iterator[Section]:
    """Each technique on the stage and in the abstract world, by name; then the failures."""
    parameters = AbstractParameters()
    world = abstract_scene(np.random.default_rng(seed), parameters)
    eye = orbit(parameters, aspect).camera().eye * 0.55
    near = look_at(eye, np.zeros(3), fov_y=0.6, near=5, far=250)
    places = (("stage", *stage, 11.5), ("abstract", world, near, float(np.linalg.norm(eye))))
    for name in registry.known("technique"):
        technique = registry.get("technique", name)
        yield Section(
            technique.title,
            technique.instruction,
            tuple(
                _plate(name, where, Shot(scene, camera, (400, 300)), reach)
                for where, scene, camera, reach in places
            ),
        )
    yield Section(
        "Where techniques fail",
        "Each picture is exact: what is wrong with it is the technique's own.",
        tuple(
            Plate(f"fails-{name}", f"{named(name).technique.title}: {f.words}", f.scene, f.camera,
                  f.parameters)
            for name, f in failures().items()
        ),
    )  # fmt: skip


def placed(name: str, shot: Shot, reach: float) -> tuple[Parameters, object]:
    """A technique's parameters and state, with its pointer somewhere, its volumes as large as the
    scene asks and up to a depth, and things transparent that have no tag."""
    p = named(name)
    known = {field.name for field in fields(p)}
    scale = reach / 11.5
    values: dict[str, object] = {"depth": reach} if "depth" in known else {}
    values |= {"radius": 1.1 * scale} if name == "dig" else {}
    values |= {"radius": 2.6 * scale} if name == "balloon" else {}
    if "kinds" in known and "wall" not in {thing.kind for thing in shot.scene.objects}:
        values["kinds"] = tuple(sorted({o.kind for o in shot.scene.objects if not o.target}))
    p = replace(p, **values)
    state = p.technique.begin(p)
    for event in (events.PointerMove(0.0, *POINTER, 0.0, 0.0), events.KeyPress(0.1, "q")):
        if isinstance(event, events.PointerMove) or name == "dig":
            state, _ = p.technique.on_event(p, state, event, shot)
    return p, state


def _plate(name: str, where: str, shot: Shot, reach: float) -> Plate:
    p, state = placed(name, shot, reach)
    if "kinds" in {field.name for field in fields(p)}:
        # Of one kind only, so that it is not taken for constant transparency.
        kinds = Counter(o.kind for o in shot.scene.objects if not o.target)
        only: dict[str, object] = {"kinds": (kinds.most_common(1)[0][0],)}
        p = replace(p, **only)
    title = f"{p.technique.title}, {where}"
    return Plate(f"technique-{where}-{name}", title, shot.scene, shot.camera, p, state=state)
