"""Languages are complete and say the same things; a study's own texts replace known ones."""

import re

import pytest

from seethrough.experiment.errors import InputError
from seethrough.experiment.pages.texts import Texts
from seethrough.renderer.models import MODELS

LANGUAGES = ["en", "de"]


def placeholders(texts):
    return {key: sorted(re.findall(r"\{(\w+)\}", texts[key])) for key in texts.keys()}


@pytest.mark.parametrize("language", LANGUAGES)
def test_languages_have_the_same_keys_and_placeholders(language):
    assert placeholders(Texts(language)) == placeholders(Texts("en"))
    assert all(Texts(language)[key].strip() for key in Texts(language).keys())


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_model_has_a_name(language):
    assert {f"kind.{name}" for name in MODELS} <= Texts(language).keys()


def test_placeholders_are_filled_and_values_that_are_keys_are_translated():
    texts = Texts("de")
    assert texts.fill("progress", (("set", "2"), ("sets", "8"))) == "Teil 2 von 8"
    assert texts.fill("feedback.right", (("answer", "kind.cat"),)) == "Katze ist richtig."


def test_a_study_replaces_texts_by_key_and_unknown_keys_are_named():
    assert Texts("en", {"welcome.title": "Hello"})["welcome.title"] == "Hello"
    with pytest.raises(InputError, match=r"texts\.welcom: unknown text.*\? known: continue, begin"):
        Texts("en", {"welcom": "x"})


def test_an_unknown_language_is_named():
    with pytest.raises(InputError, match=r"study\.language = \"xx\": expected one of de, en$"):
        Texts("xx")
