"""What is looked up from a lattice is clicked where it lies in the view that there is."""

import numpy as np
import pytest

from seethrough.experiment.people.runs.data_mode import play_session
from seethrough.experiment.people.runs.look_tables import TableEyes, moved
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.people.runs.pool import drawing
from seethrough.experiment.study.config import parse
from seethrough.experiment.suites.plain_looks import plain_look
from seethrough.renderer.scene.camera import Camera
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.controls import changed
from seethrough.tasks.worlds.scene.scene_parameters import SceneParameters
from seethrough.tasks.worlds.scene.scene_place import opened
from seethrough.tasks.worlds.scene.standing import standing

ASPECT = 4 / 3
STUDY = {
    "study": {"name": "s", "title": "S", "description": "S", "participants": 2, "seed": 1},
    "technique": {"use": "standard"},
    "world": {"use": "scene", "scene": {"files": ["office"], "move": "walk", "start": "entrance"}},
    "task": {"limit": 900.0},
    "practice": {"trials": 0},
    "design": {"tasks": ["locate"], "trials": 4},
}


@pytest.mark.parametrize(("file", "move"), [("office", "walk"), ("jeep", "orbit")])
def test_a_look_lies_where_the_view_has_it(file, move):
    """Of 40 views beside the lattice: everything that both hold, to rounding, and nothing beyond
    the view."""
    p = SceneParameters((file,), move=move)
    place = opened(p, file)
    scene, start = place.scene, standing(place, p, ASPECT)
    eyes = TableEyes(KeptLooks(), file, len(scene.objects), p.lattice,
                     lambda scene, camera: plain_look(View(scene, camera), ASPECT))  # fmt: skip
    rng, off = np.random.default_rng(3), []
    for yaw in rng.uniform(-3, 3, 40):
        camera: Camera = changed(start, yaw=float(yaw)).camera()
        raw, truth = eyes.look(scene, camera), plain_look(View(scene, camera), ASPECT)
        seen = moved(raw, scene, eyes.nearest(camera), camera, ASPECT)
        both = seen.visible & np.isfinite(truth.position).all(axis=1)
        assert np.allclose(seen.position[both], truth.position[both], atol=1e-9)
        shown = seen.position[seen.visible]
        assert ((shown >= 0) & (shown <= [ASPECT, 1])).all()
        assert np.isnan(seen.position[~seen.visible]).all()
        off.append(np.abs(raw.position - truth.position)[both].max(initial=0.0))
    assert max(off) > 0.05  # by so much of the view's height clicks would have gone astray


def test_people_in_data_mode_find_things_and_hit_them():
    """They searched until the time was up, for what they had found and clicked beside."""
    study = parse(STUDY, "s")
    rows = play_session(study, 1, 5, drawing(study, 0)).trials
    assert len(rows) == 4 and not any(row["timed_out"] for row in rows)
    assert sum(int(row["wrong_clicks"]) for row in rows) <= 4  # a slip a trial; some 50 astray
