"""A study's own language: what is to be translated, what is refused; nothing else shows."""

import re
import shutil
import tomllib
from dataclasses import replace

import pytest

from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.pages.pages import Paragraph
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.session import questionnaire
from seethrough.experiment.session.moments import moments_of
from seethrough.experiment.study.config import find, load, parse
from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.translated_from import sources
from seethrough.experiment.study.translations import (
    demand_texts,
    needed,
    own_texts,
    texts_of,
    unshowable,
)
from seethrough.tasks.catalog import TASKS

FRENCH = find("french")
FILE = FRENCH.parent / "languages" / "fr.toml"


@pytest.fixture
def beside(tmp_path):
    """The study and its language in a folder; `beside(old, new)` changes the language."""

    def changed(old="", new=""):
        text = FRENCH.read_text("utf-8").replace("languages/fr.toml", "fr.toml")
        (tmp_path / "french.toml").write_text(text, "utf-8")
        french = FILE.read_text("utf-8")
        assert old in french
        (tmp_path / "fr.toml").write_text(french.replace(old, new, 1), "utf-8")
        return str(tmp_path / "french.toml")

    return changed


class Keeps:
    def __init__(self):
        self.pages = []

    def ask(self, page):
        self.pages.append(page)
        return {"button": "0", "age": "", **dict.fromkeys(page.required, "0"),
                **{b.name: "1,2" for b in page.asked if type(b).__name__ == "Ranking"}}  # fmt: skip


def shown(page, texts):
    """What a page says, as it is drawn."""
    found = [texts.get(page.title), *map(texts.get, page.buttons)]
    for block in page.blocks:
        for name in ("text", "low", "high"):
            found += [texts.fill(getattr(block, name))] if getattr(block, name, "") else []
        found += [texts.get(option) for option in getattr(block, "options", ())]
    return found


def test_no_page_of_a_french_study_says_anything_in_english():
    """Every text on each page is one of the file's, or made of them."""
    study = load("french")
    texts = texts_of(study, "languages/fr.toml")
    french = {t.lower() for t in texts_in(tomllib.loads(FILE.read_text("utf-8")))}
    person, known = Keeps(), {}
    moments = moments_of(session_for(1, study.plan))
    list(questionnaire.asked(questionnaire.before(study, 1), person, known))
    for now in moments:
        list(questionnaire.asked(questionnaire.between(study, 1, now, moments), person, known))
    list(questionnaire.asked(questionnaire.after(study, 1), person, known))
    said = [text for page in person.pages for text in shown(page, texts)]
    assert len(said) > 60
    assert [text for text in said if text and text.lower() not in french] == []
    titles = [texts.get(page.title) for page in person.pages if page.name.startswith("view")]
    assert titles == ["À propos de ce que vous venez de faire"] * 2
    assert texts.get(study.general.title) == "Compter à travers les choses"


def texts_in(table):
    for value in table.values():
        yield from texts_in(value) if isinstance(value, dict) else (value,)


def test_a_title_made_of_levels_is_translated():
    """A question without a title of its own is called after the levels that it is about."""
    table = load("french").resolved()
    for asked in table["questions"]:
        if asked["name"] == "view":
            asked["title"] = ""
    plain = parse({**table, "translations": {}}, "made")
    own = {k: f"«{v}»" for k, v in own_texts(plain).items()}
    file = "languages/fr.toml"
    study = parse({**table, "translations": {file: {**needed(plain), **own}}}, "made")
    person = Keeps()
    moments = moments_of(session_for(1, study.plan))
    list(questionnaire.asked(questionnaire.between(study, 1, moments[2], moments), person))
    list(questionnaire.asked(questionnaire.between(study, 1, moments[3], moments), person))
    texts = texts_of(study, file)
    named = [texts.get(b.text) for b in person.pages[0].blocks if isinstance(b, Paragraph)]
    assert named == ["«without help»"] or named == ["«with see-through view»"]


FAULTS = [
    ('title = "Bienvenue"', 'title = ""', "welcome.title: missing, expected what is in English"),
    ('title = "Bienvenue"', 'title = "  "', "welcome.title: missing"),
    ('title = "Bienvenue"', 'titel = "Bienvenue"', "welcome.titel = "),
    ('title = "Bienvenue"', "title = 3", "welcome.title = 3: expected text"),
    ('title = "Bienvenue"', 'title = "欢迎"', "expected letters that the font has, not 欢 迎"),
    ("{set} sur {sets}", "{set}", "expected these places for values: {sets}, {set}"),
    ("{set} sur {sets}", "{set} {sets} {x}", "expected these places for values: {sets}, {set}"),
    ('plain = "sans aide"', 'plane = "sans aide"', "study.factors.view.plane = "),
    ('items_4 = "J’ai manqué certaines choses."', "", "study.questions.view.items_4: missing"),
    ("[welcome]", "[welcome", "not valid TOML"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), FAULTS)
def test_a_text_that_cannot_be_shown_is_named(beside, old, new, words):
    with pytest.raises(InputError) as error:
        load(beside(old, new))
    assert any(words in line and "fr.toml" in line for line in error.value.lines), error.value


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("missing.toml", "No such file"),
        ("../fr.toml", "not a file beside"),
        ("fr", "one of de, en"),
    ],
)
def test_a_language_that_is_not_there_is_refused(beside, tmp_path, language, words):
    path = tmp_path / "french.toml"
    beside()
    path.write_text(path.read_text("utf-8").replace('"fr.toml"', f'"{language}"'), "utf-8")
    with pytest.raises(InputError, match=re.escape(words)):
        load(str(path))


def test_a_study_whose_own_words_the_font_lacks_is_refused(beside, tmp_path):
    beside()
    path = tmp_path / "french.toml"
    path.write_text(
        path.read_text("utf-8").replace("I missed some things.", "I missed 漢."), "utf-8"
    )
    with pytest.raises(InputError, match=r"questions\.view\.items_4 = .*not 漢"):
        load(str(path))


def test_which_letters_the_font_has():
    """Roboto has Latin, Greek and Cyrillic; Chinese, Arabic and emoji it has not."""
    assert unshowable("Zażółć gęślą jaźń, naïveté, Ωμέγα, Жизнь – “x” … €") == ""
    assert unshowable("漢字 and ق and 🙂") == "ق 字 漢 🙂"


def test_what_is_to_be_translated_is_written_and_nothing_is_lost(beside, tmp_path, capsys):
    path = beside('title = "Bienvenue"', 'title = ""')
    out = tmp_path / "new.toml"
    assert cli.main(["texts", path, "--language", "fr", "--out", str(out)]) == 0
    assert " texts, 1 to be filled in" in capsys.readouterr().out
    made, before = (tomllib.loads(p.read_text("utf-8")) for p in (out, FILE))
    assert made["welcome"].pop("title") == "" and before["welcome"].pop("title") == "Bienvenue"
    assert made == before
    assert '# "Welcome"' in out.read_text("utf-8")
    for words, message in (
        (["--language", "fr"], "exists already"), (["--language", "f/r"], "expected a language"),
        (["--language", "xx9"], "--language = xx9: expected a language tag, as fr, pt-BR"),
        (["--language", "f"], "expected a language tag"), (["--language", "fr-"], "expected a l"),
    ):  # fmt: skip
        assert cli.main(["texts", path, *words]) == 2
        said = capsys.readouterr().err
        assert message in said and said.count("\n") == 1


def test_a_text_that_was_changed_after_it_was_translated_is_noticed(beside, tmp_path, capsys):
    """By check, and by who asks for the texts again: the old translation stands beside it."""
    path = beside()
    assert cli.main(["check", path, "--config-only"]) == 0
    assert "translated from" not in capsys.readouterr().out
    study = tmp_path / "french.toml"
    old = "I missed some things."
    study.write_text(study.read_text("utf-8").replace(old, "I found all things."), "utf-8")
    assert cli.main(["check", path, "--config-only"]) == 0
    (line,) = (x for x in capsys.readouterr().out.splitlines() if x.startswith("texts"))
    assert line.endswith(
        'fr.toml: study.questions.view.items_4: translated from "I missed some things.", which is '
        '"I found all things." now: WARNING, expected a translation of that, with it in the '
        "comment above"
    )
    out = tmp_path / "new.toml"
    assert cli.main(["texts", path, "--language", "fr", "--out", str(out)]) == 0
    assert "1 to be filled in, 1 of them again: the study has other" in capsys.readouterr().out
    text = out.read_text("utf-8")
    assert (
        '# before: "J’ai manqué certaines choses.", of "I missed some things."\n'
        '# "I found all things."\nitems_4 = ""\n'
    ) in text
    filled = text.replace('items_4 = ""', 'items_4 = "J’ai tout trouvé."')
    (tmp_path / "fr.toml").write_text(filled, "utf-8")
    assert cli.main(["check", path, "--config-only"]) == 0
    assert "translated from" not in capsys.readouterr().out


def test_what_a_text_was_translated_from_stands_right_above_it():
    """However a file is written by hand; where nothing is said, nothing is known."""
    text = (
        'a.b = "x"\n# "c"\nd.e = "y"\n# "q"\n"f.g" = """\nz"""\n[h]\n# "i"\n\nj = "k"\n# no\n'
        'l = "m"\n# "first"\n# "second"\nn = "o"\n[p.q]\n# "r"\ns = "t" # "x"\n[p]\n# "u\\n"\n'
        'v = "w"\n# 3\nw = "x"\n'
    )
    expected = {"d.e": "c", "f.g": "q", "h.n": "second", "p.q.s": "r", "p.v": "u\n"}
    assert sources(text) == expected
    plain = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    assert sources(plain) == {} and sources("") == {}


@pytest.mark.parametrize("tag", ["pt-BR", "zh-Hant-TW", "es-419", "sl-rozaj", "de-1996", "haw"])
def test_languages_are_called_by_their_tags(tmp_path, tag):
    shutil.copy(find("demo"), tmp_path / "demo.toml")
    assert cli.main(["texts", str(tmp_path / "demo.toml"), "--language", tag]) == 0
    assert (tmp_path / f"{tag}.toml").is_file()


def test_a_new_template_names_every_text_with_nothing_in_it(tmp_path):
    shutil.copy(find("demo"), tmp_path / "demo.toml")
    assert cli.main(["texts", str(tmp_path / "demo.toml"), "--language", "eo"]) == 0
    table = tomllib.loads((tmp_path / "eo.toml").read_text("utf-8"))
    assert {*texts_in(table)} == {""}
    study = load("demo")
    assert len(list(texts_in(table))) == len(needed(study))


def test_the_words_go_with_the_data_and_into_the_digest(beside, tmp_path):
    study = load(beside())
    other = load(beside("Bienvenue", "Bonjour"))
    assert study.digest() != other.digest()
    again = parse(study.resolved(), "sidecar")
    assert again.digest() == study.digest()
    assert texts_of(again, "fr.toml")["welcome.title"] == "Bienvenue"
    assert "translations" not in load("demo").resolved()


def test_texts_of_studies_without_own_languages_are_as_they_were():
    study = load("published")
    texts = texts_of(study, "de")
    plain = Texts("de", study.texts)
    assert {k: texts[k] for k in texts.keys()} == {k: plain[k] for k in plain.keys()}


@pytest.mark.parametrize("replaced", [{}, {"count.extra": "Mehr"}])
def test_a_plug_in_without_the_language_is_refused_and_replayed(monkeypatch, replaced):
    """Before anybody reads it in English, unless the study says it itself; what was shown so is
    shown so again."""
    task = TASKS["count"]
    more = {**task.texts, "en": {**task.texts["en"], "count.extra": "More"}}
    monkeypatch.setattr(type(task), "texts", more)
    study = replace(load("published"), texts=replaced)
    demand_texts(study, "en")
    assert texts_of(study, "de")["count.extra"] == replaced.get("count.extra", "More")
    if replaced:
        demand_texts(study, "de")
        return
    with pytest.raises(InputError, match=r'"de": no text in it of count[.]extra'):
        demand_texts(study, "de")
