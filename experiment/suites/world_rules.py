"""What a world has to be."""

from __future__ import annotations

from collections.abc import Iterator
from string import ascii_lowercase

import numpy as np

from seethrough.experiment.suites.played import ASPECT, KEYS, anything, no_clock
from seethrough.experiment.suites.suite import (
    Rule,
    describes_itself,
    parameters_declared,
    texts_in_every_language,
    unknown_texts,
)
from seethrough.renderer.events import KeyPress, Tick
from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.catalog import taken
from seethrough.tasks.kit.world import FILES, OWN, SHARED, World

MOVING = ("orbit", "walk", "fixed")


def says_what_it_is(world: World) -> Iterator[str]:
    """It says what it is: name, source, how one moves, whose its scenes are."""
    yield from describes_itself(world, ("scenario", "moving", "controls"))
    if world.moving not in MOVING:
        yield f"moving = {world.moving!r}: expected one of {', '.join(MOVING)}"
    if getattr(world.Parameters(), "scenes", None) not in (OWN, SHARED, FILES):
        yield "Parameters: expected a key `scenes`, as tasks.kit.world.scenes() makes it"


def refuses_wrong_parameters(world: World) -> Iterator[str]:
    """Its parameters are declared, and wrong ones refused by name."""
    yield from parameters_declared(world.Parameters)


def has_its_texts(world: World) -> Iterator[str]:
    """All that it says is in every language."""
    yield from texts_in_every_language(world, (world.name, world.scenario))
    yield from unknown_texts({world.controls})


def makes_the_same_place_again(world: World) -> Iterator[str]:
    """One stream, one place; another stream, another one, unless it is from a file; nothing but the
    stream decides."""
    p = world.Parameters()
    with no_clock(world):
        one, two, other = (world.make(np.random.default_rng(s), p).scene for s in (1, 1, 2))
    if not np.array_equal(one.transforms, two.transforms):
        yield "one stream made two places"
    if (
        p.scenes != FILES
        and one.transforms.shape == other.transforms.shape
        and np.array_equal(one.transforms, other.transforms)
    ):
        yield "two streams made one place"


def has_something_to_look_for(world: World) -> Iterator[str]:
    """There are things in it, at places that are numbers, and some of them are targets."""
    for seed in (1, 2, 3):
        scene = world.make(np.random.default_rng(seed), world.Parameters()).scene
        if not len(scene.objects) or not scene.targets.any():
            yield f"seed {seed}: expected objects, some of them targets"
        if not np.isfinite(scene.transforms).all():
            yield f"seed {seed}: expected finite transforms"


def moves_by_events_alone(world: World) -> Iterator[str]:
    """Where one looks from follows from events, as `moving` says, and old viewers stay where they
    were."""
    p = world.Parameters()
    place = world.make(np.random.default_rng(1), p)
    start = world.viewer(place, p, ASPECT)
    events = anything(np.random.default_rng(1), 200)
    viewers = [start]
    for event in events:
        viewers.append(viewers[-1].on_event(event))
    again = start
    for number, event in enumerate(events, start=1):
        again = again.on_event(event)
        a, b = again.camera(), viewers[number].camera()
        if not (np.array_equal(a.eye, b.eye) and np.array_equal(a.rotation, b.rotation)):
            yield f"event {number}: two ways from the same events"
        if not np.isfinite(a.eye).all():
            yield f"event {number}: the camera is nowhere"
    cameras = [viewer.camera() for viewer in viewers]
    moved = any(
        not np.array_equal(a.eye, cameras[0].eye)
        or not np.array_equal(a.rotation, cameras[0].rotation)
        for a in cameras
    )
    if moved == (world.moving == "fixed"):
        found = "something" if moved else "nothing"
        yield f"moving = {world.moving!r}: but of {len(events)} events {found} moves the viewer"


def says_which_keys_it_takes(world: World) -> Iterator[str]:
    """Every key that moves the viewer is one that it takes."""
    p = world.Parameters()
    start = world.viewer(world.make(np.random.default_rng(1), p), p, ASPECT)
    for name in sorted({*ascii_lowercase, *KEYS} - {k.removeprefix("key:") for k in taken(world)}):
        after = start.on_event(KeyPress(0.0, name)).on_event(Tick(1.0)).camera()
        before = start.on_event(Tick(0.0)).on_event(Tick(1.0)).camera()
        if not (np.array_equal(after.eye, before.eye)
                and np.array_equal(after.rotation, before.rotation)):  # fmt: skip
            yield f"moves by {name}, which `takes` lacks"


def can_be_certified(world: World) -> Iterator[str]:
    """It says from where scenes are judged, and how far there is to go."""
    p = world.Parameters()
    place = world.make(np.random.default_rng(1), p)
    first = world.viewer(place, p, ASPECT).camera()
    views = world.views(p, first)
    if not views or not all(isinstance(camera, Camera) for camera in views):
        yield "views: expected one camera or more"
    asked = place.scene.centers[place.scene.targets][:3]
    for some in (asked, asked[:0]):
        path = world.path(first, some)
        if not (np.isfinite(path) and path >= 0):
            yield f"path = {path!r}: expected world units"


RULES: tuple[Rule[World], ...] = (
    says_what_it_is,
    refuses_wrong_parameters,
    has_its_texts,
    makes_the_same_place_again,
    has_something_to_look_for,
    moves_by_events_alone,
    says_which_keys_it_takes,
    can_be_certified,
)
