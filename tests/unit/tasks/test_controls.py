"""Motion between events: closed forms, and the same for any frame rate."""

from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from seethrough.renderer import events
from seethrough.renderer.events import KeyPress, KeyRelease, PointerMove, Tick
from seethrough.tasks.kit.controls import orbit, turned, walk
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.abstract.abstract_scene import abstract_scene
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

ABSTRACT, BUILDING = AbstractParameters(), BuildingParameters()
KEYS = st.sampled_from(["left", "right", "up", "down", "x"])


def play(control, events):
    for event in events:
        control = control.on_event(event)
    return control


@st.composite
def performances(draw):
    """Key and pointer events at rising times."""
    events, time = [Tick(0.0)], 0.0
    for _ in range(draw(st.integers(0, 12))):
        time += draw(st.floats(0, 2))
        kind = draw(st.integers(0, 2))
        if kind == 2:
            dx, dy = draw(st.floats(-0.5, 0.5)), draw(st.floats(-0.5, 0.5))
            events.append(PointerMove(time, 0.5, 0.5, dx, dy, draw(st.booleans())))
        else:
            events.append((KeyPress, KeyRelease)[kind](time, draw(KEYS)))
    return [*events, Tick(time + 1.0)]


def at_rate(events, hertz):
    """The events with a tick before each frame, as a display sends them."""
    frames = [Tick(i / hertz) for i in range(int(events[-1].time * hertz) + 1)]
    return sorted([*events, *frames], key=lambda e: e.time)


@settings(max_examples=60, deadline=None)
@given(performances(), st.sampled_from([7.0, 60.0]))
def test_where_one_ends_up_does_not_depend_on_the_frame_rate(events, hertz):
    for start in (walk(BUILDING, (2.5, 2.5), 0.3), orbit(ABSTRACT, 4 / 3)):
        plain, framed = play(start, events), play(start, at_rate(events, hertz))
        # The same motion in more pieces: rounding of up to 2,000 sums of numbers up to 200.
        assert_allclose(framed.camera().eye, plain.camera().eye, atol=1e-9)
        assert_allclose(framed.camera().rotation, plain.camera().rotation, atol=1e-9)


def test_walking_straight():
    end = play(walk(BUILDING, (1.0, 2.0)), [KeyPress(10.0, "up"), Tick(12.0)])
    assert_allclose([end.x, end.z, end.yaw], [1, 2 - 2 * 6, 0])
    back = play(end, [KeyRelease(12.0, "up"), KeyPress(12.0, "down"), Tick(13.0)])
    assert_allclose([back.x, back.z], [1, 2 - 6])
    left = play(walk(BUILDING, (0.0, 0.0), pi / 2), [KeyPress(0.0, "up"), Tick(1.0)])
    assert_allclose([left.x, left.z], [-6, 0], atol=1e-12)


def test_walking_on_an_arc_is_a_circle():
    """Turning left while walking: a circle of radius speed / turn rate, back after one turn."""
    start = walk(BUILDING, (0.0, 0.0))
    keys = [KeyPress(0.0, "up"), KeyPress(0.0, "left")]
    radius, turn = 6.0 / 1.5, 2 * pi / 1.5
    half = play(start, [*keys, Tick(turn / 2)])
    assert_allclose([half.x, half.z], [-2 * radius, 0], atol=1e-12)
    quarter = play(start, [*keys, Tick(turn / 4)])
    assert_allclose([quarter.x, quarter.z], [-radius, -radius], atol=1e-12)
    assert_allclose(quarter.yaw, pi / 2)
    full = play(start, [*keys, Tick(turn)])
    assert_allclose([full.x, full.z], [0, 0], atol=1e-12)


@pytest.mark.parametrize("rate", [0.05, 1e-1, 10.0])
def test_arc_agrees_with_many_small_straight_steps(rate):
    p = BuildingParameters(key_turn_rate=rate)
    end = play(walk(p, (0.0, 0.0)), [KeyPress(0.0, "up"), KeyPress(0.0, "right"), Tick(1.0)])
    steps = 20_000
    yaw = -rate * (np.arange(steps) + 0.5) / steps
    # The midpoint rule's error is rate² · length / 24 / steps², below 1e-7.
    assert_allclose(end.x, -np.sin(yaw).sum() * 6 / steps, atol=1e-7)
    assert_allclose(end.z, -np.cos(yaw).sum() * 6 / steps, atol=1e-7)


def test_pointer_turns_the_walker_and_keys_never_strafe():
    end = play(walk(BUILDING, (0.0, 0.0)), [PointerMove(0.0, 0.9, 0.5, 0.25, 0.4)])
    assert_allclose(end.yaw, -pi / 4)  # to the right: yaw is positive to the left
    assert_allclose(end.camera().rotation[1], [0, 1, 0])  # no pitch, whatever dy
    turned_only = play(walk(BUILDING, (0.0, 0.0)), [KeyPress(0.0, "left"), Tick(1.0)])
    assert (turned_only.x, turned_only.z) == (0.0, 0.0)
    assert_allclose(turned_only.yaw, 1.5)


def test_opposite_keys_cancel_and_time_never_runs_back():
    both = [KeyPress(0.0, "up"), KeyPress(0.0, "down"), Tick(5.0)]
    assert play(walk(BUILDING, (0.0, 0.0)), both).z == 0.0
    late = [KeyPress(5.0, "up"), Tick(3.0), Tick(6.0)]
    assert_allclose(play(walk(BUILDING, (0.0, 0.0)), late).z, -6.0)


def test_dragging_turns_the_world_with_the_pointer():
    start = orbit(ABSTRACT, 4 / 3)
    moved_only = start.on_event(PointerMove(0.0, 0.5, 0.5, 0.2, 0.2, dragging=False))
    assert (moved_only.yaw, moved_only.pitch) == (start.yaw, start.pitch)
    dragged = start.on_event(PointerMove(0.0, 0.5, 0.5, 0.25, 0.1, dragging=True))
    assert_allclose([dragged.yaw, dragged.pitch], [-pi / 4, 0.35 + 0.1 * pi])
    # A point in the middle of the near side follows the pointer to the right and down.
    near = start.camera().rotation[:, 2] * 40
    before, after = (c.rotation.T @ near for c in (start.camera(), dragged.camera()))
    assert after[0] > before[0] + 1 and after[1] < before[1] - 1


def test_orbit_stops_overhead_and_sees_from_there():
    top = play(orbit(ABSTRACT, 4 / 3), [KeyPress(0.0, "up"), Tick(10.0)])
    assert top.pitch == pi / 2
    camera = top.camera()
    assert_allclose(camera.eye, [0, top.distance, 0], atol=1e-10)
    assert_allclose(camera.forward, [0, -1, 0], atol=1e-12)
    down = play(top, [KeyRelease(10.0, "up"), KeyPress(10.0, "down"), Tick(10.5)])
    assert_allclose(down.pitch, pi / 2 - 0.5)


@settings(max_examples=20, deadline=None)
@given(st.floats(-4, 4), st.floats(-pi / 2, pi / 2), st.sampled_from([0.75, 1.0, 4 / 3, 2.4]))
def test_no_object_leaves_the_frustum_whichever_way_the_world_is_turned(yaw, pitch, aspect):
    control = orbit(AbstractParameters(start_pitch=pitch), aspect, yaw)
    camera = control.camera()
    assert_allclose(np.linalg.norm(camera.eye), control.distance, rtol=1e-12)
    corners = np.array(np.meshgrid([-50, 50], [-50, 50], [-50, 50])).reshape(3, -1).T
    clip = np.insert(corners, 3, 1, axis=1) @ (camera.projection(aspect) @ camera.view()).T
    assert (np.abs(clip[:, :3]) <= clip[:, 3:]).all()


def test_the_farthest_objects_are_in_the_view_too():
    scene = abstract_scene(np.random.default_rng(2), ABSTRACT)
    camera = orbit(ABSTRACT, 4 / 3).camera()
    points = np.concatenate(
        [o.mesh.vertices @ o.transform[:3, :3].T + o.transform[:3, 3] for o in scene.objects]
    )
    clip = np.insert(points, 3, 1, axis=1) @ (camera.projection(4 / 3) @ camera.view()).T
    assert (np.abs(clip[:, :3]) <= clip[:, 3:]).all()


def test_turned_is_a_rotation_with_the_named_axes():
    for yaw, pitch in ((0.3, 0.7), (-2.0, 1.5)):
        matrix = turned(yaw, pitch)
        assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-15)
        assert_allclose(np.linalg.det(matrix), 1)
        assert_allclose(matrix[1, 0], 0)  # the camera's right axis stays level
    assert_allclose(-turned(pi / 2)[:, 2], [-1, 0, 0], atol=1e-15)  # left of −z is −x
    assert_allclose(-turned(0.0, 0.5)[:, 2], [0, np.sin(0.5), -np.cos(0.5)])


def test_no_event_passes_for_another():
    """A drag that ended with the right button would be one that nobody ended."""
    kinds = (
        events.PointerPress, events.PointerRelease, events.SecondPress, events.SecondRelease,
        events.Wheel, events.PointerMove, events.KeyPress, events.KeyRelease, events.Tick,
    )  # fmt: skip
    assert not [(a, b) for a in kinds for b in kinds if a is not b and issubclass(a, b)]
