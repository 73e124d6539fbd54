"""What the gallery shows: every technique, parameter, look and hard case, as scenes to draw."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from seethrough.experiment.gallery import gallery_hard, gallery_looks, gallery_techniques
from seethrough.experiment.gallery.gallery_plates import DYNAMIC, LARGE, Plate, Section
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import (
    GRANULARITIES,
    MASKS,
    DynamicTransparency,
)
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.controls import orbit, walk
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

# Of the largest pictures: shadows and corners where things stand, not where they float.
STANDING = Look(antialiasing="edges", ground_shadows=0.8, occlusion=0.8)
LOOKS = {"abstract": Look(antialiasing="edges"), "walkthrough": STANDING, "jeep": STANDING}
BUILDING = 3  # the seed of one whose first room has models behind its walls


def sections(aspect: float, seed: int = 1) -> Iterator[Section]:
    """The gallery from top to bottom."""
    scenes = views(aspect, seed)
    yield Section(
        "The three scenes and the models",
        "Standard rendering beside dynamic transparency. Edges are smooth, corners are dark, and "
        "what stands on a floor has a shadow: keys of a study's [look].",
        tuple(_scenes(aspect, scenes)),
    )
    yield from gallery_looks.sections(scenes)
    yield from gallery_techniques.sections({"stage": stage(), **scenes})
    yield from _options()
    yield from gallery_hard.sections()


def views(aspect: float, seed: int) -> dict[str, tuple[Scene, Camera]]:
    """Elmqvist2009's scenes by name, and from where they are seen."""
    from seethrough.renderer.models.vehicles.jeep import jeep_scene

    parameters = AbstractParameters()
    world = abstract_scene(np.random.default_rng(seed), parameters)
    start = orbit(parameters, aspect).camera()
    near = look_at(start.eye * 0.55, np.zeros(3), fov_y=0.6, near=5, far=250)
    building = BuildingParameters()
    house = unique_building(np.random.default_rng(BUILDING), building)
    view = walk(building, house.start).camera()
    side = look_at(np.array([2.2, 1.5, -2.6]), np.array([0.0, 0.42, 0.0]), fov_y=0.47)
    return {
        "abstract": (world, near),
        "walkthrough": (house.scene, view),
        "jeep": (jeep_scene(), side),
    }


def _scenes(aspect: float, scenes: dict[str, tuple[Scene, Camera]]) -> Iterator[Plate]:
    """The scenes, each drawn both ways, and the contact sheet of the models."""
    from seethrough.renderer.models.sheet import contact_sheet_scene

    captions = {
        "abstract": "The abstract world: 200 shapes, the red ones are targets",
        "walkthrough": "The building: all models are targets",
        "jeep": "The jeep: engine, gearbox, axles and seats are targets",
    }
    for name, caption in captions.items():
        scene, camera = scenes[name]
        scene = dressed(scene, LOOKS[name])
        words = f"{caption}; standard"
        yield Plate(f"{name}-standard", words, scene, camera, Standard(), LARGE)
        words = f"{caption}; dynamic transparency"
        yield Plate(f"{name}-dynamic", words, scene, camera, DYNAMIC, LARGE)
    sheet, camera = contact_sheet_scene(aspect)
    yield Plate("models", "Every model of the library", sheet, camera, Standard(), LARGE)


def stage() -> tuple[Scene, Camera]:
    """A horse, a chair and a torus behind a fence of three groups of planks, a ball before it."""
    from seethrough.renderer.models import MODELS

    rng = np.random.default_rng(4)
    objects = []
    for k in range(12):
        wood = tuple(np.array([0.55, 0.5, 0.42]) + rng.uniform(-0.14, 0.14, 3))
        place = transforms.translation(0.72 * (k - 5.5), 0.0, 0.0)
        plank = Object(geometry.box(0.68, 4.6, 0.12), place, wood, kind="plank", group=k // 4)
        objects.append(plank)
    ball = transforms.translation(-0.4, -0.9, 1.3)
    objects.append(Object(geometry.sphere(1.0, 2), ball, (0.25, 0.5, 0.75)))
    for name, x, y, size, turn in (("horse", -0.3, -0.2, 2.8, 0.5), ("chair", 2.6, -0.4, 2.0, 2.6)):
        mesh = MODELS[name]()
        scale = size / np.ptp(mesh.vertices, axis=0).max()
        local = transforms.placed((x, y, -2.2), transforms.rotation_y(turn), scale)
        middle = transforms.translation(*(-mesh.vertices.mean(axis=0)))
        objects.append(Object(mesh, local @ middle, target=True, kind=name))
    ring = transforms.placed((-2.9, 0.6, -2.2), transforms.rotation_x(1.2))
    objects.append(Object(geometry.torus(0.7, 0.25, 32, 16), ring, (0.85, 0.15, 0.1), target=True))
    camera = look_at(np.array([0.6, 0.8, 9.5]), np.zeros(3), fov_y=0.55, near=1, far=40)
    return Scene(tuple(objects)), camera


def _options() -> Iterator[Section]:
    """One section for each thing that the technique may vary, on the same stage."""
    scene, camera = stage()

    def shown(
        name: str, caption: str, technique: DynamicTransparency = DYNAMIC, scene: Scene = scene
    ) -> Plate:
        return Plate(name, caption, scene, camera, technique)

    plain = Plate("stage-standard", "Standard rendering", scene, camera, Standard())
    yield Section(
        "Masks",
        "The part that has the target's opacity, and the gradient about it.",
        (
            plain,
            *(shown(f"mask-{m}", f"Mask: {m}", replace(DYNAMIC, mask=m, width=14)) for m in MASKS),
        ),
    )
    widths = (
        shown(f"width-{w}", f"A border of {w} pixels", replace(DYNAMIC, width=w))
        for w in (0, 10, 30)
    )
    clear = (
        shown(f"alpha-{a:g}", f"Occluders keep {100 * a:g} %", replace(DYNAMIC, alpha_target=a))
        for a in (0.1, 0.3)
    )
    yield Section("Width and opacity", "10 pixels and 30 % are the defaults.", (*widths, *clear))
    yield Section(
        "Granularity",
        "What turns transparent as a whole. The planks are three groups.",
        tuple(
            shown(f"granularity-{g}", f"By {g}", replace(DYNAMIC, granularity=g))
            for g in GRANULARITIES
        ),
    )
    light = replace(DYNAMIC, mode="active", radius=0.2, softness=0.08)
    yield Section(
        "Modes",
        "Passive: every mask works. Active: masks work in a searchlight that follows the pointer.",
        (
            shown("mode-passive", "Passive"),
            shown(
                "mode-active", "Active, pointer at the horse", replace(light, pointer=(0.62, 0.5))
            ),
            shown(
                "mode-active-aside",
                "Active, pointer at the torus",
                replace(light, pointer=(0.2, 0.4)),
            ),
            shown("mode-active-none", "Active, the pointer is away: standard", light),
        ),
    )
    yield from _adding_up(scene, shown)


def _adding_up(scene: Scene, shown: Callable[..., Plate]) -> Iterator[Section]:
    """Layers, models of transparency, and what never turns transparent."""
    yield Section(
        "Layers and how they add up",
        "The ball and the fence are two layers before the horse.",
        (
            *(
                shown(
                    f"layers-{m}", f"At most {m} layer{'s' * (m != 1)}", replace(DYNAMIC, layers=m)
                )
                for m in (0, 1, 2)
            ),
            shown("model-additive", "Additive transparency", replace(DYNAMIC, model="additive")),
            shown(
                "kept", "80 % of the light kept for sure", replace(DYNAMIC, min_transmittance=0.8)
            ),
            shown(
                "combine-min",
                "Where masks line up, the least counts",
                replace(DYNAMIC, combine="min"),
            ),
        ),
    )
    hard = [replace(o, impenetrable=o.group == 1) for o in scene.objects]
    yield Section(
        "Impenetrable things and the order of objects",
        "What is impenetrable never turns transparent, or not until the viewer is near.",
        (
            shown(
                "impenetrable", "The middle of the fence is impenetrable", scene=Scene(tuple(hard))
            ),
            shown(
                "penetrable-near",
                "Only the ball is near enough",
                replace(DYNAMIC, penetrable_within=8.3),
            ),
            shown(
                "order-centers",
                "Order by the groups' centres, as in the paper",
                replace(DYNAMIC, order="centers"),
            ),
            shown("order-planes", "Order by planes between boxes (default)"),
            shown("order-exact", "Every pixel sorted by itself", replace(DYNAMIC, exact=True)),
        ),
    )
