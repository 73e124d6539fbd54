"""Items rotate: over a cycle each stands in each cell and at each place equally often, and nobody
meets one twice."""

from collections import Counter
from dataclasses import replace

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.balance import cycle
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.study_items import StudyItems
from seethrough.experiment.study.study_scenes import StudyScenes

STUDY = """
[study]
name = "items"
title = "Items"
description = "Parts of a gearbox."
participants = 6
seed = 5
[factors.view]
levels.plain = {{ technique.use = "standard" }}
levels.dynamic = {{ technique.use = "dynamic" }}
levels.glass = {{ technique.use = "constant" }}
{more}
[world]
use = "scene"
[world.scene]
files = ["assembly"]
[design]
tasks = ["locate", "select"]
trials = {trials}
[practice]
trials = 1
"""
ASKED = """[factors.asked]
levels.name = { task.locate.show = "name" }
levels.picture = { task.locate.show = "picture" }
"""


def study(tmp_path, trials=2, more=""):
    (tmp_path / "items.toml").write_text(STUDY.format(trials=trials, more=more), "utf-8")
    return load(str(tmp_path / "items.toml"))


def met(study, slot):
    """(task, cell, place in the set, item) of all trials of a session, practice included."""
    items = StudyItems(study)
    for task_set in session_for(slot, study.plan):
        for trial in (*task_set.training, *task_set.trials):
            place = ("practice" if trial.training else "trial", trial.in_set)
            yield trial.task, tuple(trial.levels.values()), place, items.of(trial)


@pytest.mark.parametrize("more", ["", ASKED])
def test_nobody_meets_an_item_twice(tmp_path, more):
    """Also where another factor changes what is asked of the same scene."""
    made = study(tmp_path, more=more)
    for slot in range(1, 13):
        for task in ("locate", "select"):
            found = [item for t, _, _, item in met(made, slot) if t == task]
            assert len(set(found)) == len(found)


def test_over_a_cycle_each_item_stands_in_each_cell_equally_often(tmp_path):
    """Counted from sessions, as are the rows: each item keeps its place in the set."""
    made = study(tmp_path)
    counted, places = Counter(), {}
    for slot in range(1, cycle(made.plan, 0) + 1):
        for task, cell, place, item in met(made, slot):
            counted[task, cell, item] += 1
            assert places.setdefault((task, item), place) == place
    for task in ("locate", "select"):
        own = {(cell, item): n for (t, cell, item), n in counted.items() if t == task}
        items, cells = {item for _, item in own}, {cell for cell, _ in own}
        assert (len(items), len(cells)) == (9, 3)
        assert len(own) == 27 and len(set(own.values())) == 1


def test_the_instruction_shows_an_item_that_nobody_meets(tmp_path):
    made = study(tmp_path)
    scenes = StudyScenes(made)
    everything = {i for slot in range(1, 13) for t, _, _, i in met(made, slot) if t == "locate"}
    trial = next(s.trials[0] for s in session_for(1, made.plan) if s.trials[0].task == "locate")
    assert scenes.setting(scenes.example(trial)).item not in everything


def test_the_order_of_items_comes_from_the_seed(tmp_path):
    made = study(tmp_path)
    other = replace(made, general=made.general.model_copy(update={"seed": 6}))
    first, second = ([i for *_, i in met(s, 1)] for s in (made, other))
    assert first == [i for *_, i in met(made, 1)] and first != second


def test_too_few_items_are_refused_with_the_number(tmp_path):
    """3 cells × (8 + 1) are 27; with the factor that asks twice as often, 54."""
    for trials, more, needed, cells in ((8, "", 27, 3), (4, ASKED, 30, 6)):
        with pytest.raises(InputError) as raised:
            study(tmp_path, trials, more)
        said = raised.value.lines
        assert len(said) == 2  # locate and select
        assert f"locate takes {needed} items" in said[0] and f"each of {cells} cells" in said[0]
        assert said[0].endswith("there are 24")
