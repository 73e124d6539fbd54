"""What frames leave in textures and buffers is never read: all of it is made loud before each."""

from __future__ import annotations

from dataclasses import replace

import moderngl
import numpy as np
import pytest
from sample_scenes import SHAPES, before_column, column

from seethrough import registry
from seethrough.renderer.gpu.device import reused
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models.simple import simplified
from seethrough.renderer.reference.reference import exact
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.geometry import box
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import translation
from seethrough.renderer.techniques import changed, named
from seethrough.renderer.techniques.dynamic.dynamic_transparency import MASKS, DynamicTransparency
from seethrough.tasks.kit.controls import walk
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

SIZE = (76, 60)  # ends within a block, on both sides
SORTED = DynamicTransparency(width=8, exact=True)
DEFAULT = DynamicTransparency(width=8)
# Half a step of rounding, and what 16-bit colours in the slices add (test_every_option.py).
EXACT_TOLERANCE = 1.0
# Where 32 bits and 64 disagree about an edge by more than the reference leaves out.
EDGE = 1
PLATE = geometry.box(4, 3, 0.1)
HOUSE = BuildingParameters(grid=6, objects=8, count=(1, 3), types=("chair", "table", "cat"))


@pytest.fixture(autouse=True)
def loud(monkeypatch):
    monkeypatch.setattr(reused, "LOUD", True)


def near_things(seed):
    """Things strewn from behind the eye on, mirrored or not, many cut by the near plane."""
    rng = np.random.default_rng(seed)
    objects = []
    for _ in range(12):
        z = rng.uniform(-9, 0.6)
        spread = 0.35 * max(0.6, -z) + 0.2
        scale = rng.uniform(0.4, 1.2, 3) * rng.choice([-1, 1], 3)
        place = (*rng.uniform(-spread, spread, 2), z)
        placed = transforms.placed(place, transforms.random_rotation(rng), scale)
        mesh = (*SHAPES, PLATE)[rng.integers(5)]
        target = bool(rng.random() < 0.4)
        objects.append(Object(mesh, placed, tuple(rng.uniform(0.1, 1, 3)), target=target))
    return Scene(tuple(objects)), Camera(np.zeros(3), np.eye(3), 0.9, 0.15, 50.0)


def held(renderer, scene, camera):
    """Sorted by pixel and by default, both keep to the bounds that hold elsewhere."""
    for technique in (SORTED, DEFAULT):
        renderer.draw(scene, camera, technique)
        truth = exact(scene, camera, technique, renderer.size)
        apart = np.abs(renderer.read() - truth.picture * 255).max(axis=2)[~truth.near_edge]
        if technique.exact:
            assert (apart > EXACT_TOLERANCE).sum() <= EDGE
        else:  # so much of the picture may be left in doubt, and no more is
            assert (apart > 2).sum() <= technique.doubt * apart.size


@pytest.mark.parametrize("first", range(0, 200, 25))
def test_two_hundred_scenes_that_the_near_plane_cuts(context, first):
    renderer = Renderer(context, SIZE)
    cut = 0
    for seed in range(first, first + 25):
        scene, camera = near_things(seed)
        held(renderer, scene, camera)
        cut += int((renderer.plan.boxes.crosses & renderer.plan.boxes.inside).sum())
    assert cut > 25


@pytest.mark.parametrize("seed", range(10))
def test_ten_walks_through_walls(context, seed):
    """Steps of 12 cm and a turn each, through whatever stands in the way."""
    building = unique_building(np.random.default_rng(seed), HOUSE)
    scene, renderer = simplified(building.scene), Renderer(context, SIZE)
    yaw = 0.7 * seed
    for step in range(5):
        ahead = 0.24 * step + 2.0 * (seed % 4)
        place = (building.start[0] - np.sin(yaw) * ahead, building.start[1] - np.cos(yaw) * ahead)
        held(renderer, scene, walk(HOUSE, place, yaw + 0.05 * step).camera())


OPTIONS = {
    "default": {},
    "sorted": {"exact": True},
    "parts": {"doubt": 0.0},
    "least": {"min_transmittance": 0.4, "exact": True},
    "counted": {"min_transmittance": 0.6},
    "surface": {"granularity": "surface"},
    "region": {"granularity": "region"},
    "layers": {"layers": 1},
    "additive": {"model": "additive"},
    "active": {"mode": "active", "pointer": (0.6, 0.5), "exact": True},
    "polygons": {"order": "polygons"},
    **{mask: {"mask": mask, "exact": True} for mask in MASKS},
}


EVERY = {
    **{name: replace(DEFAULT, **options) for name, options in OPTIONS.items()},
    **{f"technique {name}": named(name) for name in registry.known("technique")},
    "all surfaces": changed(named("constant"), surfaces="all"),
    "lines": changed(named("cutaway"), edges=0.8),
    "lines of all": changed(named("blueprint"), surfaces="all", layers=None),
    "by polygons": changed(named("constant"), order="bsp"),
}


@pytest.mark.parametrize("samples", [0, 4])
@pytest.mark.parametrize("name", EVERY)
def test_a_frame_is_the_same_whatever_was_drawn_before(context, name, samples):
    """To the bit: a crowd that fills the view, then three things in its middle."""
    rng = np.random.default_rng(4)
    crowd = Scene(tuple(
        Object(box(1, 1, 1), translation(*rng.uniform(-3, 3, 3)), target=k % 7 == 0)
        for k in range(60)
    ))  # fmt: skip
    few = Scene(tuple(
        Object(box(0.6, 0.6, 0.6), translation(0.1 * z, 0, -z), target=z == 2) for z in range(3)
    ))  # fmt: skip
    camera = look_at(np.array([0.3, 0.2, 8.0]), np.zeros(3), fov_y=0.7, near=1, far=20)
    renderer = Renderer(context, SIZE, samples)
    renderer.draw(crowd, camera, EVERY[name])
    renderer.draw(few, camera, EVERY[name])
    used = renderer.raw()
    fresh = Renderer(context, SIZE, samples)
    fresh.draw(few, camera, EVERY[name])
    assert used == fresh.raw()


@pytest.mark.parametrize("name", OPTIONS)
def test_a_loud_frame_is_the_quiet_frame(context, monkeypatch, name):
    """To the bit, whatever the technique asks for; so are what `look` and `shares` find."""
    technique = EVERY[name]
    found = []
    for on in (False, True):
        monkeypatch.setattr(reused, "LOUD", on)
        renderer = Renderer(context, SIZE)
        pictures = []
        for scene, camera in ((column(3), before_column(3)), near_things(7), near_things(8)):
            renderer.draw(scene, camera, technique)
            look = renderer.look(scene, camera, technique, (50, 38))
            pictures += [renderer.raw(), look.pixels.tobytes(), look.area.tobytes()]
            shares = renderer.shares(scene, camera, technique, (50, 38))
            pictures += [share.tobytes() for _, share in shares]
        found.append(pictures)
    assert found[0] == found[1]


class Watched:
    """A context that keeps a list of what is made empty, to be filled by frames."""

    def __init__(self, context):
        self.__dict__.update(context=context, made=[])

    def __getattr__(self, name):
        value = getattr(self.context, name)
        if name not in ("texture", "depth_texture", "depth_renderbuffer", "renderbuffer", "buffer"):
            return value

        def make(*args, **options):
            thing = value(*args, **options)
            data = args[0] if name == "buffer" and args else options.get("data")
            if data is None and not (name == "texture" and len(args) > 2):
                self.made.append(thing)
            return thing

        return make

    def __setattr__(self, name, value):
        setattr(self.context, name, value)


def test_everything_that_frames_fill_is_made_loud(context, monkeypatch):
    """All but the rows of a scene, which stay as long as it does, and what a frame made alone."""
    spoiled = set()
    spoil = reused.spoil

    def noted(*things):
        spoiled.update(id(t) for t in things if t is not None)
        spoil(*things)

    monkeypatch.setattr(reused, "spoil", noted)
    monkeypatch.setattr("seethrough.renderer.gpu.per_pixel.pixel_cells.spoil", noted)
    monkeypatch.setattr("seethrough.renderer.gpu.device.targets.spoil", noted)
    watched = Watched(context)
    renderer = Renderer(watched, SIZE)
    for _ in range(2):  # what the first frame made is loud before the second
        for name, technique in EVERY.items():
            # What is drawn polygon by polygon keeps rows of its own.
            if name == "by polygons" or getattr(technique, "order", None) == "polygons":
                continue
            for scene, camera in ((column(3), before_column(3)), near_things(7)):
                renderer.draw(scene, camera, technique)
                renderer.look(scene, camera, technique, (50, 38))
    rows = {id(table.table) for table in renderer._tables.values()}
    alive = [t for t in watched.made if not isinstance(t.mglo, moderngl.InvalidObject)]
    left_out = [t for t in alive if id(t) not in spoiled | rows]
    assert len(alive) > 12
    assert not left_out
