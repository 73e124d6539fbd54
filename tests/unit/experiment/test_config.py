"""The study file: what ships is valid, and what is wrong is said in one line."""

import copy
import tomllib

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import find, load, parse, shipped
from seethrough.experiment.study.tables.keys import keys_of
from seethrough.experiment.study.tables.study_tables import TABLES

PUBLISHED = tomllib.loads(find("published").read_text(encoding="utf-8"))


def changed(table, key, value):
    study = copy.deepcopy(PUBLISHED)
    own = study
    for name in table.split("."):
        own = own.setdefault(name, {})
    own[key] = value
    return study


def test_every_shipped_study_is_valid():
    assert {"published", "demo"} <= set(shipped())
    for name in shipped():
        assert load(name).general.name == name


def test_the_published_study_is_the_published_study():
    study = load("configs/published.toml")
    assert study.general.participants == 16
    assert study.design.trials == 3
    assert len(study.plan.conditions()) == 4
    abstract, building = study.places()
    assert (abstract.side, abstract.objects, abstract.target_share) == (100.0, 200, (0.1, 0.2))
    assert (building.grid, building.objects) == (16, 50)
    assert (study.practice.limit, study.session.limit) == (300.0, 4800.0)


# Each row: table, key, value, and the message after "study.toml: ".
W, B, D = r"world\.abstract\.", r"world\.building\.", r"technique\.dynamic\."
WRONG = [
    (
        "world.abstract",
        "objcts",
        200,
        W + r"objcts = 200: unknown key, did you mean objects\? known: side, objects, target",
    ),
    (
        "world.abstract",
        "objects",
        "many",
        W + r"objects = \"many\": expected a whole number from 1 to 5000$",
    ),
    (
        "world.abstract",
        "objects",
        0,
        W + r"objects = 0: expected a whole number from 1 to 5000$",
    ),
    (
        "world.abstract",
        "side",
        float("nan"),
        W + r"side = nan: expected a number from 1 to 10000$",
    ),
    (
        "world.abstract",
        "shapes",
        ["cow"],
        W + r"shapes = \[\"cow\"\]: expected an array of some of \"sphere\", ",
    ),
    (
        "world.abstract",
        "radius",
        ["a", 3],
        W + r"radius = \[\"a\", 3\]: expected \[lowest, highest\], numbers from",
    ),
    (
        "world.building",
        "grid",
        True,
        B + r"grid = true: expected a whole number from 2 to 64$",
    ),
    (
        "technique.dynamic",
        "alpha_target",
        3,
        D + r"alpha_target = 3\.0: expected a number from 0 to 1",
    ),
    ("design", "trials", 0, r"design\.trials = 0: expected a whole number from 1 to 100$"),
    (
        "design",
        "tasks",
        [],
        r"design\.tasks = \[\]: expected an array of some of .*, each once, at least 1$",
    ),
    ("design", "tasks", ["juggle"], r"design\.tasks\[0\] = \"juggle\": expected one of \"coun"),
    ("design", "tasks", ["count", "count"], r"design\.tasks = .*: expected each name once"),
    ("study", "name", "a b", r"study\.name = \"a b\": expected 1 to 32 letters and digits "),
    ("study", "seed", -1, r"study\.seed = -1: expected a whole number from 0 to 2\^63"),
    ("display", "samples", 3, r"display\.samples = 3: expected one of \"auto\", 0, 2, 4, 8$"),
    (
        "task",
        "limit",
        -3,
        r"task\.limit = -3: expected a number from 0 to 1e\+09$",
    ),
    (
        "analysis",
        "alpha",
        1.5,
        r"analysis\.alpha = 1\.5: expected a number from 0 to 1, above 0 and below 1$",
    ),
    ("analysis", "tests", ["time", "x"], r"analysis\.tests\[1\] = \"x\": expected \"time\", \"acc"),
    ("analysis", "tests", ["time", "time"], r"analysis\.tests = .*: expected each name once"),
    ("analysis", "exclude", ["x"], r"analysis\.exclude\[0\] = \"x\": expected one of timed_out, "),
    ("analysis", "exclude", ["participant:.."], r"analysis\.exclude\[0\] = .* or participant:ID"),
    ("analysis", "pairwise", ["view"], r"analysis\.pairwise\[0\] = \"view\": .*transparency"),
    ("analysis", "aligned_ranks", 2, r"analysis\.aligned_ranks = 2: expected true or false$"),
    ("techniques", "x", 1, r"techniques = \{\"x\": 1\}: unknown key"),
    ("texts", "welcome.text", 3, r"texts\.welcome\.text = 3: expected text$"),
]


@pytest.mark.parametrize(("table", "key", "value", "message"), WRONG)
def test_wrong_values_are_named_with_file_key_and_expectation(table, key, value, message):
    with pytest.raises(InputError, match=r"^study\.toml: " + message) as caught:
        parse(changed(table, key, value), "study.toml")
    assert "\n" not in str(caught.value)


def test_missing_table_is_named():
    study = copy.deepcopy(PUBLISHED)
    del study["study"]
    with pytest.raises(
        InputError, match=r"study\.toml: study: missing, expected a table, \[study\]$"
    ):
        parse(study, "study.toml")


def test_every_fault_of_a_file_has_its_line():
    study = changed("world.abstract", "objcts", 200)
    study["world"]["abstract"] |= {"side": -1.0, "shapes": ["cow"], "radius": [3.0, 2.0]}
    study["study"] |= {"seed": "x", "language": "fr"}
    study["texts"] = {"welcome.txt": "Hello."}
    study["world"]["building"]["models"] = [{"name": "a", "up": "x", "colour": 1}, 3]
    with pytest.raises(InputError) as caught:
        parse(study, "s.toml")
    assert [
        line.partition(": expected")[0].partition(", did")[0] for line in caught.value.lines
    ] == [
        's.toml: study.seed = "x"',
        's.toml: study.language = "fr"',
        "s.toml: world.abstract.objcts = 200: unknown key",
        "s.toml: world.abstract.side = -1.0",
        's.toml: world.abstract.shapes = ["cow"]',
        "s.toml: world.building.models[0].colour = 1: unknown key; known: name, file, "
        "size, up, turn, detail, sha256, reader",
        "s.toml: world.building.models[0].file: missing, expected the name of a file beside the "
        "study",
        's.toml: world.building.models[0].up = "x"',
        "s.toml: world.building.models[1] = 3",
        "s.toml: texts.welcome.txt: unknown text",
    ]
    assert "one of de, en" in caught.value.lines[1]  # which languages there are
    assert "did you mean welcome.text?" in caught.value.lines[-1]


def test_what_is_wrong_in_levels_is_told_with_what_is_wrong_besides(tmp_path):
    """A study corrected line by line needs one look, whatever table a fault is in."""
    path = tmp_path / "own.toml"
    text = find("demo").read_text("utf-8")
    changes = {
        "side = 60.0": "side = -1.0",
        "seed = 7": "seed = -7",
        'technique.use = "dynamic"': 'technique.use = "dynamik"',
        '"unique"': '"uniqe"',
        'when = "end", of': 'when = "ende", of',
    }
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    path.write_text(text, "utf-8")
    with pytest.raises(InputError) as caught:
        load(str(path))
    told = [line.removeprefix(f"{path}: ").partition(": ")[0] for line in caught.value.lines]
    assert sorted(told) == [
        'factors.scenario.levels.walkthrough.design.tasks[0] = "uniqe"',
        'factors.transparency.levels.dynamic.technique.use = "dynamik"',
        'questions.comparison.when = "ende"',
        "study.seed = -7",
        "world.abstract.side = -1.0",
    ]


def test_an_unknown_key_of_every_table_lists_its_known_ones():
    for table in TABLES:
        known = list(keys_of(table))
        with pytest.raises(InputError) as caught:
            parse(changed(table, "qqq", 1), "s.toml")
        assert str(caught.value) == (
            f"s.toml: {table}.qqq = 1: unknown key; known: {', '.join(known)}"
        )
        near = known[0][:-1] + "_"
        with pytest.raises(InputError, match=f"did you mean {known[0]}[?]"):
            parse(changed(table, near, 1), "s.toml")
    with pytest.raises(InputError, match=r"desing = .*, did you mean design\? known: factors"):
        parse(changed("desing", "trials", 3), "s.toml")


def test_of_very_many_faults_the_first_are_told_at_once():
    study = copy.deepcopy(PUBLISHED)
    study["design"] |= {f"key{number}": number for number in range(50_000)}
    with pytest.raises(InputError) as caught:
        parse(study, "s.toml")
    assert len(caught.value.lines) == 41 and caught.value.lines[-1] == "… and 49960 more"


def test_a_file_is_read_as_editors_save_it(tmp_path):
    text = find("demo").read_text(encoding="utf-8")
    path = tmp_path / "study.toml"
    right = load("demo").digest()
    for saved in (text.encode("utf-8-sig"), text.replace("\n", "\r\n").encode("utf-8-sig")):
        path.write_bytes(saved)
        assert load(str(path)).digest() == right
    for encoding in ("utf-16", "utf-16-le", "utf-16-be"):
        path.write_bytes(text.encode(encoding))
        with pytest.raises(InputError) as caught:
            load(str(path))
        assert str(caught.value) == f"{path}: is UTF-16, not UTF-8; expected to be saved as UTF-8"
    path.write_text(text.replace("seed = 7", "seed = 7\nseed = 8"), encoding="utf-8")
    with pytest.raises(InputError, match=r"a key that stands there already .*line 9.*: seed = 8$"):
        load(str(path))


@pytest.mark.parametrize(
    ("ledger", "valid"),
    [
        ("", True),
        ("postgresql://host/base", True),
        ("postgresql://user@host/base", True),
        ("postgresql://user:secret@host/base", False),
        ("postgresql://", False),
        ("postgresql://a@b@host", False),
        ("mysql://host", False),
        ("x postgresql://host", False),
    ],
)
def test_the_ledgers_address_holds_no_password(ledger, valid):
    """As the expression ^(postgresql://([^:@/]+@)?[^@]+)?$ has it, which no message shows."""
    if valid:
        assert parse(changed("session", "ledger", ledger), "s").session.ledger == ledger
    else:
        with pytest.raises(InputError, match=r"expected postgresql://USER@HOST/DATABASE without"):
            parse(changed("session", "ledger", ledger), "s")


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


def test_a_folder_is_named_as_one_with_the_studies_in_it(tmp_path):
    (tmp_path / "mine.toml").write_bytes(find("demo").read_bytes())
    (tmp_path / "broken.toml").write_text("a = [1,\n2", encoding="utf-8")
    (tmp_path / "fr.toml").write_text("[study]\ntitle = 'Texte'\n", encoding="utf-8")
    (tmp_path / "demo").mkdir()
    assert find("demo").is_file()  # a study that ships, whatever folders there are
    with pytest.raises(InputError) as error:
        load(str(tmp_path))
    assert str(error.value).endswith(
        ": a folder, expected a study's file; in it there are: broken.toml, mine.toml"
    )
    with pytest.raises(InputError, match=r"in it there are: none$"):
        load(str(tmp_path / "demo"))


def test_the_digest_tells_studies_apart_and_ignores_the_order_of_keys():
    one = parse(PUBLISHED, "x")
    reordered = dict(reversed(list(copy.deepcopy(PUBLISHED).items())))
    assert one.digest() == parse(reordered, "x").digest()
    assert one.digest() != parse(changed("technique.dynamic", "width", 11.0), "x").digest()
