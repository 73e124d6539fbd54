"""What the viewer's keys do to its picture, and what it says of the order."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.experiment import cli
from seethrough.experiment.display.viewer import Viewer, ViewState
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.models.translucent.scenes import scene
from seethrough.renderer.polygons.methods import prepare

SIZE = (160, 120)
EMPTY = 1 / 255  # of a channel: the background, as half floats hold it


@pytest.fixture(scope="module")
def viewer():
    context = standalone()
    made = scene("fence")
    yield Viewer(context, SIZE, made, prepare("bsp", made.polygons))
    context.release()


def covered(viewer, picture):
    """(h, w) where anything was drawn."""
    return np.abs(picture[..., :3] - viewer.painter.background).max(axis=-1) > EMPTY


def test_t_turns_texturing_off_and_on(viewer):
    start = ViewState(opaque=False)
    off = start.pressed("t")
    with_slats, without = viewer.picture(start), viewer.picture(off)
    # Between the slats nothing is drawn; without its texture a panel is one pane of glass.
    assert covered(viewer, without).sum() > 1.1 * covered(viewer, with_slats).sum()
    assert np.array_equal(viewer.picture(off.pressed("t")), with_slats)


def test_without_its_texture_a_panel_is_half_transparent(viewer):
    picture = viewer.picture(ViewState(texturing=False, opaque=False))
    pane = 0.5 * np.array([0.6, 0.9, 1.0]) + 0.5 * np.array(viewer.painter.background)
    # A half float's rounding in one blend.
    assert (np.abs(picture[..., :3] - pane).max(axis=-1) < 2**-10).sum() > 100


def test_o_leaves_the_opaque_geometry_out(viewer):
    start = ViewState()
    whole, clear = (viewer.picture(s) for s in (start, start.pressed("o")))
    ground = np.array([0.45, 0.6, 0.35])

    def share(picture):
        return (np.abs(picture[..., :3] - ground).max(axis=-1) < 2 / 255).mean()

    assert share(whole) > 0.05 and share(clear) == 0.0
    assert np.array_equal(viewer.picture(start.pressed("o").pressed("o")), whole)


def test_l_draws_lines_and_p_polygons(viewer):
    start = ViewState(texturing=False, opaque=False)
    filled, lines = viewer.picture(start), viewer.picture(start.pressed("l"))
    some, all_of = covered(viewer, lines), covered(viewer, filled)
    assert 0 < some.sum() < 0.6 * all_of.sum()
    # Lines are where polygons are, or beside their edges by the pixel that a line is wide.
    wider = np.pad(all_of, 1)
    near = np.any([wider[y : y + 120, x : x + 160] for y in range(3) for x in range(3)], axis=0)
    assert not (some & ~near).any()
    assert start.pressed("l").pressed("l") == start.pressed("l")
    assert np.array_equal(viewer.picture(start.pressed("l").pressed("p")), filled)


def test_other_keys_do_nothing_and_arrows_come_back(viewer):
    start = ViewState()
    assert start.pressed("x") == start
    for there, back in (("left", "right"), ("up", "down"), ("pageup", "pagedown")):
        moved = start.pressed(there)
        assert not np.array_equal(viewer.picture(moved), viewer.picture(start))
        home = moved.pressed(back)
        # Sums of floats: there and back is the start but for the last bit.
        assert (home.yaw, home.pitch, home.distance) == pytest.approx(
            (start.yaw, start.pitch, start.distance), abs=1e-12
        )


def test_the_camera_never_turns_over_or_leaves(viewer):
    state = ViewState()
    for _ in range(100):
        state = state.pressed("up").pressed("pageup")
    assert viewer.camera(state).forward[1] < -0.99
    assert np.isfinite(viewer.picture(state)).all()
    assert state.distance == 0.05


def test_the_order_s_figures_are_shown(viewer):
    stats = viewer.prepared.stats
    first, second, third = viewer.summary("bsp")
    assert first == "fence, order bsp"
    assert second == f"polygons 5 in, {stats.outputs} out, {stats.splits} splits"
    # Panels 3 and 4 each cross the first two, and the fifth crosses all of the four.
    assert stats.splits > 0 and stats.outputs == 5 + stats.splits
    assert third.startswith(f"relations tested {stats.relations}, nodes ")
    assert third.endswith(f"depth {stats.depth}")


@pytest.mark.parametrize("method", ["distance", "axis_tree", "boxes", "feudal", "feudal_dynamic"])
def test_the_command_writes_a_picture_and_says_the_figures(method, tmp_path, capsys):
    file = tmp_path / "picture.png"
    assert cli.main(["view", "fence", "--order", method, "--picture", str(file)]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == f"fence, order {method}" and len(said) == 3
    from PIL import Image

    with Image.open(file) as picture:
        assert picture.size == (960, 720)


def test_a_missing_folder_is_one_line(tmp_path, capsys):
    file = tmp_path / "missing" / "picture.png"
    assert cli.main(["view", "fence", "--picture", str(file)]) == 2
    assert capsys.readouterr().err.splitlines() == [
        f"seethrough: --picture = {file}: expected an existing folder"
    ]
