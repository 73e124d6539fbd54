"""Edges smoothed along lines: as near to many samples a pixel as is promised, nothing changed where
no edge shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seethrough.benchmarks.drawing.looks import errors
from seethrough.experiment.suites import technique_scenes
from seethrough.renderer.gpu.edges import edge_painter
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.look.edge_set import edge_set
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.look import Look
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import named
from seethrough.tasks.worlds.building.walls import wall_with_doorway

SIZE = (200, 150)
EDGES = Look(antialiasing="edges")
CAMERA = look_at(np.array([0, 0, 12.0]), np.zeros(3), fov_y=0.6, near=1, far=40)
CASES = {case.name: case for case in technique_scenes.cases()}


@pytest.fixture(scope="module")
def renderer(context):
    return Renderer(context, SIZE)


@pytest.fixture(scope="module")
def fine(context):
    return Renderer(context, (4 * SIZE[0], 4 * SIZE[1]), window=SIZE[1])


def drawn(renderer, scene, way="standard", camera=CAMERA):
    renderer.draw(scene, camera, named(way))
    return renderer.read() / 255


def test_what_the_edges_of_meshes_are():
    """Twelve of a box, all creases; a ball has none; a cylinder its two rims."""
    box = edge_set(geometry.box())
    assert box.crease.sum() == 12 and len(box.crease) == 18  # with a diagonal on each face
    assert np.allclose(np.linalg.norm(np.diff(box.ends[box.crease], axis=1), axis=2), 1.0)
    ball = edge_set(geometry.sphere(1.0, 2))
    assert len(ball.crease) == 3 * 320 // 2 and not ball.crease.any()
    assert edge_set(geometry.cylinder(segments=24)).crease.sum() == 48
    halves = geometry.sphere(1.0, 1)
    colors = np.where(halves.vertices[:, 1:2] > 0.01, 1.0, 0.3) * np.ones(3)
    tinted = replace(halves, colors=colors)  # a colour that runs from vertex to vertex breaks not
    assert not edge_set(tinted).crease.any()
    sheet = edge_set(geometry.quad())
    assert (sheet.sides == 2).any(axis=1).sum() == 4 and not sheet.crease.any()


@pytest.mark.parametrize(("way", "must"), [("standard", 0.45), ("dynamic", 0.6), ("cutaway", 0.75)])
@pytest.mark.parametrize("case", ["scattered 1", "room", "mirrored"])
def test_edges_come_near_those_of_sixteen_samples(renderer, fine, case, way, must):
    """The bench's musts are .6 and .75 of the plain picture's error, in large scenes."""
    scene = CASES[case]
    found = errors(renderer, fine, scene.scene, scene.camera, named(way))
    plain, smooth = (np.abs(found[k] - found["fine"]) for k in ("plain", "smooth"))
    at = plain.max(axis=2) > 4
    assert at.sum() > 200
    assert smooth[at].mean() < must * plain[at].mean()
    assert smooth.mean() < 0.8 * plain.mean()


@pytest.mark.parametrize("turn", [0.03, 0.4, 0.8, 1.3, 1.55])
def test_a_straight_edge_is_as_dark_as_what_it_covers(renderer, turn):
    """Against the area of each pixel under the edge of a large turned square, by 64 × 64 points."""
    plate = geometry.box(4.0, 4.0, 0.2)
    flat = Object(plate, transforms.placed((0, 0, 0), transforms.rotation_z(turn)), (0, 0, 0))
    scene = dressed(Scene((flat,), background=(1.0, 1.0, 1.0)), EDGES)
    eye = look_at(np.array([0, 0, 500.0]), np.zeros(3), fov_y=0.016, near=1, far=900)
    found = 1 - drawn(renderer, scene, camera=eye)[..., 0]
    many = (np.arange(64) + 0.5) / 64
    x = (np.arange(SIZE[0])[:, None] + many).ravel()
    slope = eye.pixel(SIZE[1]) * 499.9  # of its front face
    px = (x - SIZE[0] / 2) * slope
    c, s = np.cos(turn), np.sin(turn)
    want = np.empty(SIZE[::-1])
    for r in range(SIZE[1]):  # row by row: all points at once take gigabytes
        py = (SIZE[1] / 2 - (r + many[:, None])) * slope
        inside = (np.abs(c * px + s * py) < 2) & (np.abs(c * py - s * px) < 2)
        want[r] = inside.reshape(64, SIZE[0], 64).mean(axis=(0, 2))
    part = (want > 0) & (want < 1)
    # Where a line leaves a pixel through its side, its part there is no trapezium: .125 at most. At
    # the four corners two lines meet.
    assert np.sort(np.abs(found - want)[part])[:-8].max() < 0.13
    assert np.abs(found - want)[part].mean() < 0.06  # at 45°, where most pixels are left so
    assert np.abs(np.round(found) - want)[part].mean() > 0.15  # what it was
    assert np.array_equal(found[~part], want[~part])


def test_hidden_edges_change_nothing(renderer):
    """A wall before a heap of things: nothing within it."""
    case = CASES["scattered 1"]
    wall = Object(geometry.box(6, 6, 0.2), transforms.translation(0, 0, 3.0), (0.5, 0.6, 0.7))
    scene = Scene((*case.scene.objects, wall))
    plain = drawn(renderer, scene, camera=case.camera)
    smooth = drawn(renderer, dressed(scene, EDGES), camera=case.camera)
    alone = drawn(renderer, Scene((wall,)), camera=case.camera)
    covered = (alone != np.array(Scene(()).background).round(3)).any(axis=2)
    covered = np.abs(alone - alone[SIZE[1] // 2, SIZE[0] // 2]).max(axis=2) < 0.05
    inner = covered[1:-1, 1:-1] & covered[2:, 1:-1] & covered[:-2, 1:-1]
    inner &= covered[1:-1, 2:] & covered[1:-1, :-2]
    assert inner.sum() > 2000
    assert np.array_equal(plain[1:-1, 1:-1][inner], smooth[1:-1, 1:-1][inner])


def test_a_target_seen_through_something_has_smooth_edges(renderer, fine):
    """What stands before it has the depth; the target's edge shows all the same."""
    pane = Object(geometry.box(9, 9, 0.1), transforms.translation(0, 0, 2), (0.2, 0.3, 0.5))
    cube = transforms.placed((0, 0, -2), transforms.rotation_z(0.4))
    scene = Scene((pane, Object(geometry.box(3, 3, 3), cube, (0.9, 0.1, 0.1), target=True)))
    found = errors(renderer, fine, scene, CAMERA, named("dynamic"))
    plain, smooth = (np.abs(found[k] - found["fine"]) for k in ("plain", "smooth"))
    inside = np.zeros(SIZE[::-1], dtype=bool)
    inside[40:110, 60:140] = True  # the pane's own edges lie outside
    at = (plain.max(axis=2) > 4) & inside
    assert at.sum() > 60 and smooth[at].mean() < 0.6 * plain[at].mean()


def test_lines_that_the_near_plane_cuts_and_pictures_without_any(renderer):
    """Nothing breaks, and nothing changes where there is nothing."""
    floor = Object(geometry.box(40, 0.1, 40), transforms.translation(0, -1, 0), (0.3, 0.5, 0.3))
    eye = Camera(np.zeros(3), np.eye(3), fov_y=1.2, near=0.5, far=100)
    plain = drawn(renderer, Scene((floor,)), camera=eye)
    smooth = drawn(renderer, dressed(Scene((floor,)), EDGES), camera=eye)
    rows = np.nonzero((plain != smooth).any(axis=(1, 2)))[0]
    assert np.ptp(rows) <= 2 if len(rows) else True  # the horizon alone
    empty = dressed(Scene(()), EDGES)
    assert np.array_equal(drawn(renderer, empty), drawn(renderer, Scene(())))


@pytest.mark.parametrize("way", ["standard", "dynamic"])
@pytest.mark.parametrize("look", [EDGES, Look(outlines=6.0, antialiasing="edges")])
def test_no_more_of_a_picture_is_looked_at_than_lines_need(context, monkeypatch, way, look):
    """Against the whole of it, read and written: not a pixel is another."""
    part, whole = (Renderer(context, SIZE) for _ in range(2))
    for case in ("scattered 1", "room"):
        scene, camera = dressed(CASES[case].scene, look), CASES[case].camera
        one = drawn(part, scene, way, camera)
        with monkeypatch.context() as patched:
            patched.setattr(edge_painter, "about", lambda *_: (0, 0, *SIZE))
            assert np.array_equal(one, drawn(whole, scene, way, camera))
        assert (one != drawn(part, CASES[case].scene, way, camera)).any()


def test_samples_are_the_looks_where_it_says_so(context):
    """And the renderer's, as display.samples has it, where it says auto."""
    scene = Scene((Object(geometry.box(3, 3, 3), transforms.rotation_z(0.3), (0, 0, 0)),))
    one, four = Renderer(context, SIZE), Renderer(context, SIZE, samples=4)
    tones = {}
    for name, renderer in (("one", one), ("four", four)):
        for how in ("auto", "none", "4x", "edges"):
            look = dressed(scene, Look(antialiasing=how))
            tones[name, how] = drawn(renderer, look).tobytes()
    assert tones["one", "auto"] == tones["one", "none"] == tones["four", "none"]
    assert tones["four", "auto"] == tones["one", "4x"] == tones["four", "4x"]
    assert tones["one", "edges"] == tones["four", "edges"]
    assert len(set(tones.values())) == 3


@pytest.mark.parametrize("turn", [0.03, 0.3, 0.75, 1.2])
@pytest.mark.parametrize("width", [1.0, 2.5, 11.0])
def test_an_outline_is_as_wide_as_it_says(renderer, turn, width):
    """Down a column (or along a row) a line of width w covers w / cos of its slope."""
    plate = geometry.box(4.0, 4.0, 0.2)
    flat = Object(plate, transforms.placed((0, 0, 0), transforms.rotation_z(turn)), (1, 1, 1))
    scene = Scene((flat,))
    eye = look_at(np.array([0, 0, 500.0]), np.zeros(3), fov_y=0.016, near=1, far=900)
    plain = drawn(renderer, scene, camera=eye)
    look = Look(antialiasing="none", outlines=width)
    lined = drawn(renderer, dressed(scene, look), camera=eye)
    ink = ((plain - lined) / (plain - 0.12)).mean(axis=2) / 0.8
    steep = turn > np.pi / 4
    along = ink if not steep else ink.T
    cos = max(abs(np.cos(turn)), abs(np.sin(turn)))
    middle = along.shape[1] // 2 - 15  # away from its corners
    sums = along[: along.shape[0] // 2, middle - 5 : middle + 5].sum(axis=0)  # one edge of the four
    assert sums == pytest.approx(np.full(10, width / cos), abs=0.02 + 4 / 255)
    assert ink.max() < 1.0 + 2 / 255 and ink.min() > -2 / 255


def test_no_outline_lies_within_a_surface(renderer):
    """A wall is made of blocks that meet without being joined: only its border has a line."""
    wall = wall_with_doorway(8.0, 4.0, 0.2, (3.0, 5.0), 2.5)
    scene = Scene((Object(wall, transforms.translation(-4, -2, 0), (0.8, 0.7, 0.6)),))
    plain, lined = (
        drawn(renderer, dressed(scene, Look(antialiasing="none", outlines=w))) for w in (0.0, 1.5)
    )
    slope = CAMERA.pixel(SIZE[1]) * 11.9
    x = (np.arange(SIZE[0]) + 0.5 - SIZE[0] / 2) * slope + 4
    y = (SIZE[1] / 2 - np.arange(SIZE[1]) - 0.5) * slope + 2
    inside = ((x > 0.2) & (x < 7.8)) & ((y > 0.2) & (y < 3.8))[:, None]
    door = ((x > 2.8) & (x < 5.2)) & (y < 2.7)[:, None]
    assert (inside & ~door).sum() > 3000
    assert np.array_equal(plain[inside & ~door], lined[inside & ~door])
    assert (plain != lined)[~inside | door].any(axis=-1).sum() > 300


@pytest.mark.parametrize("antialiasing", ["none", "edges"])
@pytest.mark.parametrize("way", ["standard", "dynamic"])
def test_ink_leaves_no_trace_in_alpha(renderer, way, antialiasing):
    """How much of a pixel has ink is told there meanwhile; what it says otherwise stays."""
    case, alphas, colors = CASES["scattered 1"], [], []
    for width in (0.0, 6.0):
        scene = dressed(case.scene, Look(antialiasing=antialiasing, outlines=width))
        renderer.draw(scene, case.camera, named(way))
        picture = np.frombuffer(renderer.raw(), np.uint16).reshape(-1, 4)
        alphas.append(picture[:, 3])
        colors.append(picture[:, :3])
    assert (alphas[0] == alphas[1]).all() and (colors[0] != colors[1]).any()


def test_what_turns_transparent_keeps_its_line(renderer):
    """Over the target that shows through it, it is as dark as where the thing is opaque."""
    box = Object(geometry.box(3, 3, 0.1), transforms.translation(0, 1.5, 2), (0.3, 0.6, 0.9))
    ball = Object(geometry.sphere(2.0, 3), transforms.translation(0, 0, -3), (0.9, 0.2, 0.1), True)
    scene = Scene((box, ball))
    look = Look(antialiasing="none", outlines=2.0)
    plain, lined = (drawn(renderer, s, "dynamic") for s in (scene, dressed(scene, look)))
    ink = ((plain - lined) / np.where(np.abs(plain - 0.12) > 0.1, plain - 0.12, np.inf)).max(axis=2)
    lens = 1 / CAMERA.pixel(SIZE[1])
    row = round(SIZE[1] / 2 - 0.0 * lens / 9.95)  # of the box's lower side, before the ball
    columns = slice(SIZE[0] // 2 - 10, SIZE[0] // 2 + 10)
    assert (np.abs(plain[row + 6, columns] - plain[row - 6, columns]).max(axis=1) > 0.02).all()
    assert ink[row - 2 : row + 2, columns].max(axis=0).min() > 0.7
    drawn(renderer, scene, "dynamic")
    assert len(renderer.plan.masked) == 1  # it does turn transparent


def test_no_line_shows_through_what_is_sorted_by_pixel(renderer):
    """Nothing of that is in the depth buffer, where only the floor behind it is."""
    floor = Object(geometry.box(14, 0.2, 6), transforms.translation(0, -2, -5), (0.8, 0.8, 0.8),
                   impenetrable=True, kind="floor")  # fmt: skip
    cube = Object(geometry.box(3, 3, 3), transforms.translation(0, 0, 0), (0.2, 0.4, 0.7))
    # From the upper left to the lower right: the part that is sorted holds the cube.
    turned = transforms.placed((0, 0, -4), transforms.rotation_z(-np.pi / 4))
    bar = Object(geometry.box(8, 0.1, 0.1), turned, (1, 0, 0), target=True)
    # So that the depth behind the floor's far edge is another one.
    far = Object(geometry.box(1, 1, 1), transforms.translation(5, 4, -24), impenetrable=True)
    scene, p = Scene((floor, cube, bar, far)), replace(named("dynamic"), exact=True, width=2)
    pictures = []
    for width in (0.0, 2.0):
        look = Look(antialiasing="none", outlines=width)
        renderer.draw(dressed(scene, look), CAMERA, p)
        pictures.append(renderer.read().astype(int))
        assert 1 in renderer.plan.held
    corners = CAMERA.places(np.array([[-1.5, -1.5, 1.5], [1.5, 1.5, 1.5]])) * SIZE[1] / 2
    left, right = np.round(corners[:, 0] + SIZE[0] / 2).astype(int) + np.array([4, -4])
    bottom, top = np.round(SIZE[1] / 2 - corners[:, 1]).astype(int) + np.array([-4, 4])
    rim = CAMERA.places(np.array([[0.0, -1.9, -8.0]]))[0, 1]  # the floor's far edge
    row = round(SIZE[1] / 2 * (1 - rim))
    assert top < row - 2 and row + 2 < bottom
    band = np.s_[row - 2 : row + 3, left : (left + right) // 2]
    assert np.array_equal(pictures[0][band], pictures[1][band])
    beside = np.s_[row - 2 : row + 3, left - 20 : left - 10]
    assert (pictures[0][beside] != pictures[1][beside]).any()
