"""Simulated people go by what they see: neither names nor techniques change what they do."""

from importlib import resources

import pytest

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.people.runs.data_mode import play_trial
from seethrough.experiment.people.runs.pool import LazyDraw, Pool
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import SIMULATED, generator, session_for

DEMO = resources.files("seethrough.configs").joinpath("demo.toml").read_text("utf-8")
STANDARD = 'levels.standard = { technique.use = "standard" }'
DYNAMIC = 'levels.dynamic = { technique.use = "dynamic" }'
OPAQUE = (
    'levels.dynamic = { technique.use = "dynamic", technique.dynamic.alpha_target = 1.0, '
    "technique.dynamic.alpha_edge = 1.0 }"
)


def played(tmp_path, name, *changes):
    """The demo study with lines replaced: outcome, seconds and events of each trial of a person.

    Trial by trial, each from zero: pages that explain a level take time to read, and names decide
    which are there.
    """
    text = DEMO
    for line, instead in changes:
        assert line in text
        text = text.replace(line, instead)
    path = tmp_path / f"{name}.toml"
    path.write_text(text, encoding="utf-8")
    study = load(str(path))
    pool = Pool(study, 0, LazyDraw(study))
    person = SimulatedParticipant(generator(5, (SIMULATED, 1)))
    found = []
    for task_set in session_for(1, study.plan):
        for trial in (*task_set.training, *task_set.trials):
            record, events = play_trial(person, pool, trial)
            found.append((trial.task, record.outcome, record.time, events))
    return found


@pytest.fixture(scope="module")
def as_it_is(tmp_path_factory):
    return played(tmp_path_factory.mktemp("demo"), "demo")


def test_names_of_levels_change_nothing(tmp_path, as_it_is):
    """The technique called standard and plain called a: the same, event for event."""
    swapped = played(
        tmp_path, "demo",
        (STANDARD, STANDARD.replace("levels.standard", "levels.a")),
        (DYNAMIC, DYNAMIC.replace("levels.dynamic", "levels.standard")),
    )  # fmt: skip
    assert swapped == as_it_is and len(as_it_is) >= 8


def test_masks_that_show_nothing_are_no_masks(tmp_path, as_it_is):
    """With α_T = α_edge = 1 everything is opaque: what is done is what is done without."""
    opaque = played(tmp_path, "demo", (DYNAMIC, OPAQUE))
    plain = played(tmp_path, "plain", (DYNAMIC, DYNAMIC.replace('"dynamic" }', '"standard" }')))
    assert opaque == plain
    assert opaque != as_it_is  # something was to be seen through
