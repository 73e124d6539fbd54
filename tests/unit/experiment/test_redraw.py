"""Scenes to draw again: those that the design has, and no others."""

import tomllib

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import find, parse
from seethrough.experiment.study.design.design import session_for

PUBLISHED = tomllib.loads(find("published").read_text(encoding="utf-8"))


def study(*redraw, **design):
    """The published study, or with one level or task, its scenes drawn again."""
    table = {**PUBLISHED, "design": {**PUBLISHED["design"], "redraw": list(redraw)}}
    del table["questions"], table["analysis"]
    factors = dict(PUBLISHED["factors"])
    if "transparency" in design:
        del factors["transparency"]
        table["technique"] = {**PUBLISHED["technique"], "use": design["transparency"]}
    if "tasks" in design:
        levels = {
            "abstract": factors["scenario"]["levels"]["abstract"],
            "walkthrough": {"world": {"use": "building"}, "design": {"tasks": design["tasks"]}},
        }
        factors["scenario"] = {"levels": levels}
    return parse({**table, "factors": factors}, "s.toml")


@pytest.mark.parametrize("design", [{}, {"tasks": ["unique"]}, {"transparency": "dynamic"}])
def test_every_scene_that_somebody_meets_may_be_drawn_again(design):
    factors = study(**design).plan
    for slot in (1, 2, 7, 100):
        own = [t for s in session_for(slot, factors) for t in (*s.trials, *s.training)]
        assert study(*(trial.scene for trial in own), **design)


@pytest.mark.parametrize(
    ("name", "design"),
    [
        ("walkthrough-C-unique-1", {}),
        ("walkthrough-A-unique-4", {}),
        ("walkthrough-A-unique-0", {}),
        ("walkthrough-A-unique-training-2", {}),
        ("walkthrough-A-count-1", {}),
        ("walkthrough-A-unique-1", {"tasks": ["count_in_building"]}),
        ("walkthrough-B-unique-1", {"transparency": "dynamic"}),
        ("stream-1-1-2-0-0-1", {}),
        ("stream-1-1-1-0-0-4", {}),
        ("stream-1-0-1-0-0-1", {}),
        ("stream-1-x-1-0-0-1", {}),
        ("stream-1", {}),
        ("", {}),
        ("stream-1-99999999999999999999-0-0-0-1", {}),
    ],
)
def test_a_scene_that_there_is_not_is_refused_in_one_line(name, design):
    with pytest.raises(InputError) as caught:
        study("walkthrough-A-count_in_building-1" if not design else name, name, **design)
    said = [line for line in str(caught.value).splitlines() if "design.redraw[1]" in line]
    assert len(said) == 1 and said[0].startswith("s.toml: design.redraw[1] = ")
    assert "expected a scene of it, such as" in said[0]
