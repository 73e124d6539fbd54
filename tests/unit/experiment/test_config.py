"""The study file: what ships is valid, and what is wrong is said in one line."""

import copy
import tomllib

import pytest

from experiment.config import find, load, parse, shipped
from experiment.errors import InputError

PUBLISHED = tomllib.loads(find("published").read_text(encoding="utf-8"))


def changed(table, key, value):
    study = copy.deepcopy(PUBLISHED)
    study.setdefault(table, {})[key] = value
    return study


def test_every_shipped_study_is_valid():
    assert {"published", "demo"} <= set(shipped())
    for name in shipped():
        assert load(name).study.name == name


def test_the_published_study_is_the_published_study():
    study = load("configs/published.toml")
    assert study.study.participants == 16
    assert study.design.trials == 3
    assert len(study.design.factors().conditions) == 4
    assert (study.abstract.side, study.abstract.objects) == (100.0, 200)
    assert study.abstract.target_share == (0.1, 0.2)
    assert (study.walkthrough.grid, study.walkthrough.objects) == (16, 50)
    assert (study.session.training_limit, study.session.session_limit) == (300.0, 4800.0)


# Each row: table, key, value, and the message after "study.toml: ".
WRONG = [
    ("abstract", "objcts", 200, r"abstract\.objcts = 200: unknown key; known: side, objects"),
    ("abstract", "objects", "many", r"abstract\.objects = 'many': expected a valid integer"),
    ("abstract", "objects", 0, r"abstract\.objects = 0: expected a number from 1 to 5000"),
    ("abstract", "side", float("nan"), r"abstract\.side = nan: expected a number from 1 to"),
    ("abstract", "shapes", ["cow"], r"abstract\.shapes = \['cow'\]: expected some of \['sphere'"),
    ("abstract", "radius", ["a", 3], r"abstract\.radius = \['a', 3\]: expected a valid number"),
    ("walkthrough", "grid", True, r"walkthrough\.grid = True: expected a valid integer"),
    ("dynamic", "alpha_target", 3, r"dynamic\.alpha_target = 3\.0: expected a number from 0 to 1"),
    ("design", "trials", 0, r"design\.trials = 0: expected greater than or equal to 1"),
    ("design", "tasks", [], r"design\.tasks = \[\]: expected at least 1 item"),
    ("design", "tasks", ["juggle"], r"design\.tasks\[0\] = \"juggle\": expected 'count', 'patt"),
    ("design", "tasks", ["count", "count"], r"design\.tasks = .*: expected each name once"),
    ("study", "name", "a b", r"study\.name = \"a b\": expected text that matches"),
    ("study", "seed", -1, r"study\.seed = -1: expected greater than or equal to 0"),
    ("display", "samples", 3, r"display\.samples = 3: expected 'auto', 0, 2, 4 or 8"),
    ("session", "trial_limit", -3, r"session\.trial_limit = -3: expected greater than"),
    ("analysis", "alpha", 1.5, r"analysis\.alpha = 1\.5: expected less than 1"),
    ("analysis", "tests", ["time", "x"], r"analysis\.tests\[1\] = \"x\": expected 'time', 'acc"),
    ("analysis", "tests", ["time", "time"], r"analysis\.tests = .*: expected each name once"),
    ("analysis", "exclude", ["x"], r"analysis\.exclude\[0\] = \"x\": expected one of timed_out, "),
    ("analysis", "exclude", ["participant:.."], r"analysis\.exclude\[0\] = .* or participant:ID"),
    ("techniques", "x", 1, r"techniques = \{\"x\": 1\}: unknown key"),
    ("texts", "welcome", 3, r"texts\.welcome = 3: expected a valid string"),
]


@pytest.mark.parametrize(("table", "key", "value", "message"), WRONG)
def test_wrong_values_are_named_with_file_key_and_expectation(table, key, value, message):
    with pytest.raises(InputError, match=r"^study\.toml: " + message) as caught:
        parse(changed(table, key, value), "study.toml")
    assert "\n" not in str(caught.value)


def test_missing_table_is_named():
    study = copy.deepcopy(PUBLISHED)
    del study["study"]
    with pytest.raises(InputError, match=r"study\.toml: study: missing, expected a value"):
        parse(study, "study.toml")


def test_a_file_that_is_not_toml_or_not_there_is_one_line(tmp_path):
    broken = tmp_path / "broken.toml"
    broken.write_text("a = [1,\n2", encoding="utf-8")
    with pytest.raises(InputError, match=r"broken\.toml: not valid TOML: [^\n]*$"):
        load(str(broken))
    broken.write_bytes(b"a = '\xff'")
    with pytest.raises(InputError, match=r"broken\.toml: byte 5 is not UTF-8"):
        load(str(broken))
    with pytest.raises(InputError, match=r"nothing\.toml: no such file; expected .* published"):
        load("nothing.toml")


def test_the_digest_tells_studies_apart_and_ignores_the_order_of_keys():
    one = parse(PUBLISHED, "x")
    reordered = dict(reversed(list(copy.deepcopy(PUBLISHED).items())))
    assert one.digest() == parse(reordered, "x").digest()
    assert one.digest() != parse(changed("dynamic", "width", 11.0), "x").digest()
