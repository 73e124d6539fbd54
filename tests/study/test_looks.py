"""A look as what a study varies: from the file to the pictures that are shown again."""

import copy
import json

import numpy as np
import pytest
from recorded_session import STUDY, play_recorded

from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.replay.replayer import find_trial, replay
from seethrough.experiment.study.config import load, parse
from seethrough.experiment.study.tables.scopes import TRIAL, scope_of
from seethrough.renderer.scene.look import PLAIN, Look

CUES = {
    "none": {"technique": {"use": "standard"}},
    "fog": {"technique": {"use": "dynamic"}, "look": {"fog": 30.0, "floor_grid": 5.0}},
}


def varied(levels=None, **more):
    table = copy.deepcopy(STUDY)
    table["factors"]["cues"] = {"levels": levels or CUES}
    del table["factors"]["transparency"]
    return {**table, **more}


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    folder = tmp_path_factory.mktemp("looks") / "data"
    play_recorded(folder, varied(look={"fog_start": 2.0}))
    return folder


def test_a_level_has_its_look_and_the_rest_is_the_bases():
    study = parse(varied(look={"fog_start": 2.0}), "test")
    looks = {part.look for part in study.parts.values()}
    assert looks == {Look(fog_start=2.0), Look(fog=30.0, fog_start=2.0, floor_grid=5.0)}
    assert study.look == Look(fog_start=2.0)
    again = parse(json.loads(json.dumps(study.resolved())), "again")
    assert again.digest() == study.digest()
    assert parse(varied(), "test").digest() != study.digest()
    assert scope_of(("look", "fog")) == TRIAL


def test_the_published_study_has_no_look():
    assert {part.look for part in load("published").parts.values()} == {PLAIN}


@pytest.mark.parametrize("number", [1, 2, 3, 4, 5, 6, 7, 8])
def test_replay_draws_the_frames_that_were_shown(data, number, capsys):
    words = ["replay", str(data), "--participant", "P01", "--trial", str(number), "--verify"]
    assert cli.main(words) == 0
    assert capsys.readouterr().out.endswith(" 0 different\n")
    recorded = find_trial(data, "P01", number)
    frame = next(iter(replay(recorded)))
    foggy = recorded.trial.levels["cues"] == "fog"
    assert frame.view.scene.look.fog == (30.0 if foggy else 0.0)
    kinds = [thing.kind for thing in frame.view.scene.objects]
    abstract = recorded.trial.levels["scenario"] == "abstract"
    assert (kinds[-1] == "floor") == (abstract and foggy)
    assert frame.view.scene.look.fog_start == 2.0


def test_the_sidecar_says_how_it_looked(data):
    (sidecar,) = data.glob("data/human/P01/*_trials_data.json")
    said = json.loads(sidecar.read_text("utf-8"))
    assert said["provenance"]["study"]["look"]["fog_start"] == 2.0
    (cues,) = (f for f in said["design"]["factors"] if f["name"] == "cues")
    assert cues["levels"] == ["none", "fog"] and cues["scenes"] == "alone"


@pytest.mark.parametrize(
    ("look", "said"),
    [
        ({"fog": -1.0}, "look.fog = -1.0: expected a number from 0 to 1000000"),
        ({"fog": "thick"}, 'look.fog = "thick": expected a number from 0 to 1000000'),
        ({"floor_grid": float("nan")}, "look.floor_grid = nan: expected a number from 0"),
        ({"mist": 1.0}, "look.mist = 1.0: unknown key; known: fog, "),
        (3, "look = 3: expected a table, [look]"),
    ],
)
def test_what_is_wrong_has_its_line(look, said):
    with pytest.raises(InputError) as error:
        parse(varied(look=look), "test")
    assert any(said in line for line in error.value.faults), error.value.faults
    if isinstance(look, dict):
        levels = {"none": CUES["none"], "some": {**CUES["fog"], "look": look}}
        with pytest.raises(InputError) as error:
            parse(varied(levels), "test")
        key = said.partition(" = ")[0]
        assert any(f"factors.cues.levels.some.{key}" in line for line in error.value.faults)


def test_who_simulates_sees_the_look(context):
    """Fog takes contrast from what is far; data mode's tables of one look are none of another's."""
    from seethrough.experiment.display.looking import Looking
    from seethrough.experiment.people.runs.pool import fingerprint
    from seethrough.experiment.study.design.design import session_for
    from seethrough.experiment.study.study_scenes import StudyScenes
    from seethrough.tasks.catalog import TASKS

    study = parse(varied(), "test")
    trial = session_for(1, study.plan)[0].trials[0]
    task, part = TASKS[trial.task], study.part(trial.levels)
    view = task.view(StudyScenes(study).begin(task, trial, 4 / 3))
    looking = Looking(context, (320, 240), simple=True)
    looking.technique = part.technique
    foggy = view.dressed(Look(fog=20.0))
    plain, fog = looking.look(view), looking.look(foggy)
    both = (plain.pixels > 0) & (fog.pixels > 0)
    assert both.any() and np.array_equal(plain.pixels > 0, fog.pixels > 0)
    assert fog.contrast[both].mean() < 0.6 * plain.contrast[both].mean()
    scenes = (view.scene, foggy.scene, view.dressed(Look(fog=21.0)).scene)
    assert len({fingerprint(s, part.technique, (320, 240)) for s in scenes}) == 3
