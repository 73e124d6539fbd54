"""The jeep: pieces in a body, as the paper's third scene needs them."""

import numpy as np
import pytest

from seethrough.renderer.masks.silhouettes import topology
from seethrough.renderer.models.forms.outline import outline, square, view_axes
from seethrough.renderer.models.vehicles.jeep import INSIDE, jeep, jeep_scene

PIECES = dict(jeep())


def test_it_has_the_polygons_of_the_paper():
    """Elmqvist2009's table: about 115k."""
    assert sum(len(mesh.triangles) for mesh in PIECES.values()) == pytest.approx(115_000, rel=0.02)


def test_pieces_share_a_frame_that_stands_on_the_ground():
    low = np.min([m.bounds[0] for m in PIECES.values()], axis=0)
    high = np.max([m.bounds[1] for m in PIECES.values()], axis=0)
    assert low[1] == pytest.approx(0, abs=1e-12)
    np.testing.assert_allclose((low + high)[[0, 2]], 0, atol=1e-12)
    assert (high - low).max() == pytest.approx(2.0)
    for side in ("left", "right"):
        for end in ("front", "rear"):
            wheel = PIECES[f"{end} {side} wheel"]
            assert wheel.bounds[0, 1] == pytest.approx(0, abs=0.002)
            assert np.sign(wheel.center[0]) == (1 if side == "right" else -1)
            assert np.sign(wheel.center[2]) == (1 if end == "rear" else -1)


@pytest.mark.parametrize("name", PIECES)
def test_pieces_are_closed_and_show_no_back_face(name):
    mesh = PIECES[name]
    assert topology(mesh).closed
    np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=1), 1, atol=1e-12)
    for yaw, pitch in ((0.5, 0.3), (3.5, 0.6), (2.0, -0.5)):
        seen = outline(mesh, yaw, pitch, 96)
        assert seen.facing[seen.covered].all()


@pytest.mark.parametrize("name", INSIDE)
def test_the_inner_parts_lie_inside_the_body_and_wheels(name):
    """Within the body's box seen from above, and mostly behind body and wheels from the side."""
    low, high = PIECES["body"].bounds[:, [0, 2]]
    inner = PIECES[name].bounds[:, [0, 2]]
    assert (inner[0] >= low).all()
    assert (inner[1] <= high).all()


def test_the_bonnet_hides_the_engine_from_above():
    frame = square((PIECES["body"].vertices @ view_axes(0.0, 1.2).T)[:, :2])
    engine = outline(PIECES["engine"], 0.0, 1.2, 128, frame).covered
    body = outline(PIECES["body"], 0.0, 1.2, 128, frame).covered
    assert (engine & body).sum() > 0.98 * engine.sum()


def test_the_scene_targets_what_lies_inside():
    scene = jeep_scene()
    assert {o.kind for o in scene.objects if o.target} == set(INSIDE)
    assert [o.kind for o in scene.objects] == list(PIECES)
    assert [o.kind for o in jeep_scene(["battery"]).objects if o.target] == ["battery"]
