"""The reference of a study file's keys is what the code declares, all of it."""

import dataclasses
import re
import tomllib

import pytest

from seethrough.experiment.cli import main
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.config import find, parse
from seethrough.experiment.study.tables import plugins
from seethrough.experiment.study.tables.keys import REFERENCE, REQUIRED, keys_of, reference, tables
from seethrough.experiment.study.tables.merge import nested
from seethrough.experiment.study.tables.ready import READY
from seethrough.experiment.study.tables.scopes import sections
from seethrough.experiment.study.tables.study_tables import TABLES
from seethrough.renderer.declared import Key, Of, allowed, declared
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency
from seethrough.tasks.kit.own_models import OwnModel
from seethrough.tasks.worlds.abstract.abstract_parameters import AbstractParameters
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

FOUND_OUT = {"folder"}  # of a model, when the study is read
LEAST = {
    "technique": {"use": "standard"},
    "world": {"use": "abstract"},
    "design": {"tasks": ["count"]},
}
PUBLISHED = tomllib.loads(find("published").read_text(encoding="utf-8"))


def test_the_page_is_what_the_code_declares():
    """`python -m seethrough.experiment.study.tables.keys` makes it anew."""
    assert REFERENCE.read_text(encoding="utf-8") == reference()


def test_every_table_and_key_of_a_study_is_there():
    assert {t.partition(".")[0] for t in tables()} == {*sections(), "factors"} - {"texts"}
    for cls in (AbstractParameters, BuildingParameters, OwnModel, DynamicTransparency):
        fields = {f.name for f in dataclasses.fields(cls)}
        assert fields - set(declared(cls)) == (FOUND_OUT if cls is OwnModel else set())
    for table, declares in tables().items():
        fields = getattr(declares, "model_fields", None)
        if fields is None:
            fields = declares if isinstance(declares, dict) else declared(declares)
        assert list(keys_of(table)) == list(fields)
    page = reference()
    for name in ("language", "fullscreen", "mask", "tolerance", "redraw", "stale_after", "layers"):
        assert f"| `{name}` | " in page


def test_every_question_and_technique_has_its_section():
    """Those without keys of their own as well: nobody has to guess what there is."""
    page = reference()
    for kind, table in (("question", "questions"), ("technique", "technique"), ("world", "world")):
        for name in plugins.names(kind):
            (part,) = re.findall(rf"(?ms)^## `\[{table}\.{name}\]`$(.*?)(?=^## )", page)
            assert ("| key |" in part) != ("It has no keys" in part)
    for name, block in READY.items():
        (part,) = re.findall(rf"(?ms)^## `\[questions\.{name}\]`$(.*?)(?=^## )", page)
        assert all(f"`{item}`" in part for item in block.items(block.Parameters(), name))
        assert ("asked at the start" in part) == (name in ("consent", "demographics"))


def test_every_key_says_what_it_means_and_may_be():
    for table in tables():
        for key in keys_of(table).values():
            assert len(key.meaning) > 5 and key.allowed and "|" not in key.meaning, key
            assert not re.search(r"[\^\\$]|NoneType|<class", key.allowed.replace("2^63", "")), key


def test_the_defaults_are_allowed_and_those_of_a_study_that_sets_nothing():
    required = {
        n: PUBLISHED["study"][n] for n, k in keys_of("study").items() if k.default is REQUIRED
    }
    study = parse({"study": required, **LEAST}, "s")
    for table in TABLES:
        read = study.general if table == "study" else getattr(study, table)
        for key in keys_of(table).values():
            if key.default is not REQUIRED and key.name != "tasks":
                assert getattr(read, key.name) == key.default


def _limits():
    for cls, table in ((AbstractParameters, "world.abstract"),
                       (BuildingParameters, "world.building"),
                       (DynamicTransparency, "technique.dynamic")):  # fmt: skip
        for name, said in declared(cls).items():
            if said.low is not None:
                yield table, cls, name, said


@pytest.mark.parametrize(("table", "cls", "name", "said"), list(_limits()))
def test_what_the_page_says_is_what_is_checked(table, cls, name, said):
    """A little below the least and above the most that is allowed: refused in the page's words."""
    values = {f.name: f.default for f in dataclasses.fields(cls)}
    high = said.high.value(values) if isinstance(said.high, Of) else said.high
    hint = cls.__annotations__[name]
    for value in (said.low - 1, high * 1.01 + 1):
        number = int(value) if "int" in hint else float(value)
        wrong = [number, number] if "tuple" in hint else number
        with pytest.raises(InputError, match=rf"^s: {table}\.{name} = ") as caught:
            parse({**PUBLISHED, **nested((*table.split("."), name), wrong)}, "s")
        words = keys_of(table)[name].allowed
        start = words if not isinstance(said.high, Of) else words.rpartition(" to ")[0]
        assert f": expected {start}" in str(caught.value)


def test_limits_that_follow_from_others_name_them():
    for cls in (AbstractParameters, BuildingParameters):
        for said in declared(cls).values():
            if isinstance(said.high, Of):
                assert said.high.names and said.high.names <= set(declared(cls))
                used = set()

                class Seen(dict):
                    def __getitem__(self, key):
                        used.add(key)  # noqa: B023
                        return 1.0

                said.high.value(Seen())
                assert used == said.high.names


def test_language_lists_the_languages():
    assert keys_of("study")["language"].allowed == (
        'one of de, en, or a file of texts beside the study, as "fr.toml"'
    )


def test_the_command_prints_the_page_or_a_table(capsys):
    assert main(["keys"]) == 0
    assert capsys.readouterr().out == reference()
    assert main(["keys", "[display]"]) == 0
    part = capsys.readouterr().out
    assert part.startswith("## `[display]`") and part.count("\n## ") == 0
    assert part in reference() and "`refresh`" in part
    assert main(["keys", "displai"]) == 2
    assert "unknown table, did you mean display?" in capsys.readouterr().err


def test_a_limit_that_follows_from_others_has_its_value_only_where_they_have_one():
    """docs/keys.md names the limit; an error says besides what it comes to."""
    most = Key("how many", low=1, high=Of("twice `cell`", lambda p: 2 * p["cell"]))
    assert allowed(int, most) == "a whole number from 1 to twice `cell`"
    words = "a whole number from 1 to twice `cell` (12)"
    assert allowed(int, most, {"cell": 6, "name": "x"}) == words
