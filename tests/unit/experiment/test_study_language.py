"""A level is a part of a study: what it merges into, what it may set, what is said of faults."""

import copy
import json
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import find, load, parse, shipped
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.migrate import is_old, migrated
from seethrough.experiment.study.migrate_file import migrated_text
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.study.tables.merge import leaves, merged, nested, overlap

DATA = Path(__file__).resolve().parents[2] / "data" / "studies"
BASE = """
[study]
name = "s"
title = "s"
description = "s"
participants = 8
seed = 1
[factors.view]
levels.plain = { technique.use = "standard" }
levels.faint = { technique.use = "dynamic", technique.dynamic.alpha_target = 0.1 }
levels.strong = { technique.use = "dynamic", technique.dynamic.alpha_target = 0.5 }
[factors.clutter]
set = "world.abstract.distractors"
values = [80, 180]
order = "mixed"
[technique.dynamic]
width = 12.0
[world]
use = "abstract"
[world.abstract]
targets = [15, 25]
[design]
tasks = ["count"]
trials = 2
"""
OLD = """# A study of before.
[study]
name = "old"
title = "old"
description = "old"
participants = 4
seed = 7

[design]
transparency = ["dynamic", "standard"] # this order
trials = 2 # of each
training = 3 # to practise

[abstract]
side = 60.0 # small

[[walkthrough.models]]
name = "wedge"
file = "wedge.obj"

[session]
session_limit = 600.0 # ten minutes
trial_limit = 60.0
consent = "mine.txt"
questionnaire = ["ratings", "tlx", "depth_test"]
"""


def study(text=BASE, **more):
    return parse({**tomllib.loads(text), **more}, "s.toml")


NAMES, NUMBERS = st.sampled_from("abc"), st.integers(0, 3)
inner = st.dictionaries(NAMES, NUMBERS, max_size=3)
tables = st.dictionaries(NAMES, NUMBERS | inner, max_size=3)


@given(base=tables, part=tables)
def test_merging_sets_every_leaf_of_the_part_and_leaves_what_it_does_not_touch(base, part):
    before = copy.deepcopy(base)
    result = merged(base, part)
    assert base == before
    said = dict(leaves(result))
    own = [path for path, _ in leaves(part)]
    for path, value in leaves(part):
        if not isinstance(value, dict):
            assert said[path] == value
    for path, value in leaves(base):
        if not any(overlap(path, p) for p in own):
            assert said[path] == value


def test_arrays_are_replaced_and_parts_are_made_of_one_key():
    assert merged({"a": {"b": [1, 2], "c": 1}}, {"a": {"b": [3]}}) == {"a": {"b": [3], "c": 1}}
    assert nested(("a", "b"), 3) == {"a": {"b": 3}}


def test_each_cell_is_the_base_with_its_levels():
    made = study()
    assert [len(made.parts), len(made.plan.conditions())] == [6, 3]
    faint = made.part({"view": "faint", "clutter": "180"})
    assert (faint.technique.alpha_target, faint.technique.width) == (0.1, 12.0)
    assert (faint.place.distractors, faint.place.targets) == (180, (15, 25))
    plain = made.part({"view": "plain", "clutter": "80"})
    assert plain.technique_name == "standard" and plain.place.distractors == 80


def test_values_keep_their_type_and_their_number():
    factor = study().factor("clutter")
    assert (factor.names, factor.baseline) == (("80", "180"), "80")
    assert factor.described()["numbers"] == [80.0, 180.0]
    assert factor.levels[0].part == {"world": {"abstract": {"distractors": 80}}}


def test_what_was_resolved_is_the_same_study_again_and_orders_of_levels_are_in_its_digest():
    made = study()
    again = parse(made.resolved(), "sidecar")
    assert again.digest() == made.digest() and again.resolved() == made.resolved()
    lines = BASE.splitlines()
    at = lines.index('levels.plain = { technique.use = "standard" }')
    lines[at], lines[at + 1] = lines[at + 1], lines[at]
    assert study("\n".join(lines)).digest() != made.digest()


@pytest.mark.parametrize("name", sorted(shipped()))
def test_every_shipped_study_is_whole_and_its_record_makes_it_again(name):
    made = load(name)
    assert parse(made.resolved(), name).digest() == made.digest()
    entry = design_entry(made)
    assert [f["name"] for f in entry["factors"]] == list(made.plan.names)
    assert {t["name"] for t in entry["tasks"]} == set(made.tasks())
    assert sum(g.people for g in made.plan.groups) == made.general.participants


def test_the_sidecars_design_is_what_the_analysis_was_promised():
    view, scenario = design_entry(load("published"))["factors"]
    assert view == {
        "name": "transparency", "kind": "within", "levels": ["standard", "dynamic"],
        "numbers": None, "labels": {"standard": "standard", "dynamic": "dynamic"},
        "baseline": "standard", "scenes": "alone", "order": "williams",
    }  # fmt: skip
    assert scenario["scenes"] == "changed"
    assert scenario["tasks"] == {
        "abstract": ["count", "pattern"], "walkthrough": ["unique", "count_in_building"],
    }  # fmt: skip


# What is put into BASE instead of a line, and what is said of it.
F = "factors.view"
WRONG = [
    ('[factors.view]', '[factors.View]', 'factors = "View": expected a name of 1 to 32 lower-case'),
    ('[factors.view]', '[factors.task]', 'factors = "task": expected another name: task is a col'),
    ('[factors.view]', '[factors.view]\nlevel = 3', f"{F}.level = 3: unknown key, did you mean"),
    ('[factors.view]', '[factors.view]\nvary = "x"', f'{F}.vary = "x": expected one of within, b'),
    ('[factors.view]', '[factors.view]\norder = "x"', f'{F}.order = "x": expected one of willia'),
    ('[factors.view]', '[factors.view]\nset = "a.b"', f'{F}.set = "a.b": expected no set beside'),
    ('[factors.view]', '[factors.view]\nbaseline = "x"', f'{F}.baseline = "x": expected one of p'),
    ('[factors.view]', '[factors.view]\npeople = 4', f"{F}.people = 4: expected no people: each"),
    ('[factors.view]', '[factors.view]\nlabels = { x = "y" }', f'{F}.labels.x = "y": unknown key'),
    ('{ technique.use = "standard" }', '{ techniqe.use = "standard" }', f"{F}.levels.plain.techn"),
    ('{ technique.use = "standard" }', '{ "technique.use" = "standard" }',
     f'{F}.levels.plain.technique.use = "standard": expected a bare dotted key'),
    ('{ technique.use = "standard" }', '{ technique.use = "xray" }',
     f'{F}.levels.plain.technique.use = "xray": expected one of '),
    ('{ technique.use = "standard" }', '{ study.seed = 3 }',
     f"{F}.levels.plain.study.seed = 3: expected another key: this one is the same in the whole"),
    ('{ technique.use = "standard" }', '{ display.width = 640, technique.use = "standard" }',
     f'{F}.levels.plain.display.width = 640: expected vary = "between": this key is the same'),
    ('{ technique.use = "standard" }', '{ practice.trials = 0 }',
     f"{F}.levels.plain.technique.use: missing, expected one of "),
    ('alpha_target = 0.5', 'alpha_target = 7.5',
     f"{F}.levels.strong.technique.dynamic.alpha_target = 7.5: expected a number from 0 to 1"),
    ('{ technique.use = "standard" }', '3', f"{F}.levels.plain = 3: expected a part of a study"),
    ('values = [80, 180]', 'values = [80]', "factors.clutter.values = [\"80\"]: expected two lev"),
    ('values = [80, 180]', 'values = [80, 80]', "factors.clutter.values[1] = 80: expected each l"),
    ('values = [80, 180]', 'values = [80, "x"]', 'factors.clutter.values = [80, "x"]: expected n'),
    ('values = [80, 180]', 'values = [80, -5]', "factors.clutter.values[1] = -5: expected a whol"),
    ('"world.abstract.distractors"', '"distractors"', "factors.clutter.set = \"distractors\": exp"),
    ('"world.abstract.distractors"', '"technique.dynamic.alpha_target"',
     'factors.clutter = "technique.dynamic.alpha_target": expected a key of its own: factors.vie'),
    ('"world.abstract.distractors"', '"design.trials"',
     "factors.clutter.set = 80: expected another order: this key is the same in a whole block"),
    ('trials = 2', 'exclude = [{ view = "xray" }]', "design.exclude[0].view = \"xray\": expected"),
    ('trials = 2', 'exclude = [{ look = "plain" }]', "design.exclude[0].look = \"plain\": unknown"),
    ('trials = 2', 'exclude = [{ view = "plain" }]', "design.exclude[0] = {\"view\": \"plain\"}: "),
    ('tasks = ["count"]', 'tasks = ["unique"]', 'design.tasks[0] = "unique": expected a task of '),
    ('tasks = ["count"]', '', "design.tasks: missing, expected an array of some of "),
    ('use = "abstract"', 'use = "moon"', 'world.use = "moon": expected one of abstract, building'),
    ('use = "abstract"', '', "world.use: missing, expected one of abstract, building"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "said"), WRONG, ids=[w[2][:50] for w in WRONG])
def test_every_way_to_write_a_factor_wrongly_has_its_line(old, new, said):
    assert BASE.count(old) >= 1
    with pytest.raises(InputError) as caught:
        study(BASE.replace(old, new, 1))
    lines = caught.value.lines
    assert any(line.startswith(f"s.toml: {said}") for line in lines), lines


def test_two_factors_on_one_key_too_many_cells_and_too_few_people():
    many = {
        f"f{n}": {"set": f"world.abstract.{key}", "values": list(range(1, 61))}
        for n, key in enumerate(("distractors", "objects", "key_rate"))
    }
    with pytest.raises(InputError, match=r"factors = 216000: expected at most 10000 cells"):
        study(factors=many)
    two = {
        "view": {
            "vary": "between",
            "levels": {
                "a": {"technique": {"use": "standard"}},
                "b": {"technique": {"use": "dynamic"}},
            },
        }
    }
    with pytest.raises(InputError, match=r"study\.participants = 1: expected at least one"):
        study(BASE.replace("participants = 8", "participants = 1"), factors=two)
    with pytest.raises(InputError, match=r"factors\.view\.people = 3: expected 8 in all"):
        study(factors={"view": {**two["view"], "people": 3}})


def test_a_trial_that_may_outlast_the_session_is_refused():
    with pytest.raises(InputError, match=r"task\.limit = 700\.0: expected at most session\.limit"):
        study(task={"limit": 700.0}, session={"limit": 600.0})
    assert study(task={"limit": 700.0}, session={"limit": 0.0}).session.limit == 0


def test_a_measured_factor_sets_nothing_and_a_group_has_its_quota():
    measured = {"vary": "measured", "values": ["novice", "expert"],
                "people": {"novice": 6, "expert": 2}}  # fmt: skip
    made = study(factors={**tomllib.loads(BASE)["factors"], "expertise": measured})
    assert [(g.levels["expertise"], g.people) for g in made.plan.groups] == [
        ("novice", 6), ("expert", 2),
    ]  # fmt: skip
    assert made.plan.groups[1].measured == {"expertise": "expert"}
    with pytest.raises(InputError, match="values alone: a measured factor sets no key"):
        study(factors={"x": {**measured, "set": "world.abstract.side"}})


def test_an_old_file_gets_one_line_and_is_rewritten_with_its_comments():
    table = tomllib.loads(OLD)
    assert is_old(table) and not is_old(tomllib.loads(BASE))
    with pytest.raises(InputError, match=r"^s\.toml: written for an earlier version: .*migrate s"):
        parse(table, "s.toml")
    text = migrated_text(OLD)
    for comment in ("A study of before.", "of each", "to practise", "small", "ten minutes"):
        assert text.count(f"# {comment}") == 1
    new = tomllib.loads(text)
    assert new["world"]["building"]["models"] == [{"name": "wedge", "file": "wedge.obj"}]
    del new["world"]["building"], table["walkthrough"]
    one, two = parse(new, "n"), parse(table, "o", before=True)
    assert one.digest() == two.digest()
    assert one.factor("transparency").names == ("dynamic", "standard")
    assert (one.practice.trials, one.session.limit) == (3, 600.0)
    part = one.part({"transparency": "dynamic", "scenario": "abstract"})
    assert part.task_options.limit("count") == 60.0
    assert list(one.questions) == ["consent", "ratings", "tlx", "depth_test"]


def test_a_study_of_one_level_and_one_scenario_has_no_such_factors():
    table = {**tomllib.loads(OLD), "design": {"transparency": ["dynamic"], "tasks": ["unique"],
             "redraw": ["walkthrough-A-unique-1"]}}  # fmt: skip
    del table["walkthrough"]
    made = parse(migrated(table), "s")
    assert made.factors == () and made.plan.cells == ((),)
    assert made.part({}).technique_name == "dynamic"
    assert made.design.redraw == ("building-A-unique-1",)


def test_find_knows_examples_by_their_names():
    assert find("clutter").parent.name == "examples"


def test_a_record_of_before_there_were_factors_has_the_same_trials():
    """A sidecar's study as it was written then: what replays and exports read."""
    table = json.loads((DATA / "published_before_factors.json").read_text("utf-8"))
    assert is_old(table)
    made, now = parse(table, "sidecar", before=True), load("published")
    for slot in (1, 2, 7, 16):
        assert session_for(slot, made.plan) == session_for(slot, now.plan)
    assert made.places() == now.places()
    assert [p.technique for p in made.parts.values()] == [p.technique for p in now.parts.values()]
    assert list(made.questions) == list(now.questions)


def test_migrating_keeps_what_was_said_of_questions():
    """Above the lines, behind them, and within the array of pages; each at what it was about."""
    plain = OLD.replace('consent = "mine.txt"\n', "")
    text = plain.replace('questionnaire = ["ratings", "tlx", "depth_test"]\n', "").replace(
        "[session]\n",
        "[session] # of the session\n# first of all\n\n# the text of consent\n"
        'consent = "consent.txt" # approved in May\n# how old\ndemographics = true\n'
        "# after everything\nquestionnaire = [\n"
        '  "ratings", # short ones\n  "comparison", "remarks", # both\n] # at the end\n',
        1,
    )
    new = migrated_text(text)
    tail = new[new.index("[questions]") :].splitlines()
    assert tail[: tail.index("# short ones") + 2] == [
        "[questions] # in this order", "# after everything", "# both", "# at the end",
        "# the text of consent", "# approved in May", next(t for t in tail if "consent =" in t),
        "# how old", next(t for t in tail if "demographics =" in t), "# short ones",
        next(t for t in tail if "ratings =" in t),
    ]  # fmt: skip
    session = new[new.index("[session]") :].split("\n[")[0]
    assert "# of the session" in session and "# first of all" in session
    for said in ("consent", "how old", "after everything", "short ones", "approved"):
        assert said not in session
    assert tomllib.loads(new)["questions"]["ratings"]["when"] == "end"


def test_a_ranking_of_levels_has_an_item_for_each(tmp_path):
    study = tmp_path / "mine.toml"
    study.write_text(
        '[study]\nname = "mine"\ntitle = "Mine"\ndescription = "Ours."\n'
        "participants = 4\nseed = 1\n"
        '[factors.view.levels]\nplain = { technique.use = "standard" }\n'
        'cut = { technique.use = "cutaway" }\n'
        '[design]\ntasks = ["count"]\ntrials = 1\n[world]\nuse = "abstract"\n'
        '[questions]\norder = { use = "ranking", of = "view", text = "Which first?" }\n',
        encoding="utf-8",
    )
    assert [i["name"] for i in design_entry(load(str(study)))["items"]] == ["order_1", "order_2"]
