"""`seethrough texts`: what is to be translated for a study in a language of its own."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from seethrough.experiment.errors import InputError, short
from seethrough.experiment.study.beside.study_files import LARGEST_TEXT, read_regular
from seethrough.experiment.study.beside.toml_file import parse_toml
from seethrough.experiment.study.config import find, load
from seethrough.experiment.study.translated_from import stale
from seethrough.experiment.study.translations import needed, template
from seethrough.tasks.kit.own_texts import flat

# A language tag as RFC 5646 has it: language, script, region, variants.
TAG = re.compile(
    r"[A-Za-z]{2,3}(-[A-Za-z]{4})?(-([A-Za-z]{2}|[0-9]{3}))?(-([A-Za-z0-9]{5,8}|[0-9]\w{3}))*",
    re.ASCII,
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("study", metavar="STUDY", help="TOML file of a study")
    parser.add_argument(
        "--language", required=True, metavar="TAG", help="a language tag, as fr or pt-BR"
    )
    parser.add_argument(
        "--out", type=Path, metavar="FILE", help="default: TAG.toml beside the study"
    )


def run(arguments: argparse.Namespace) -> int:
    """Write every text that participants of the study read, to be filled in; what has been filled
    in before is taken over."""
    language = arguments.language
    if not TAG.fullmatch(language):
        raise InputError(
            f"--language = {short(language)}: expected a language tag, as fr, pt-BR or zh-Hant"
        )
    study = load(arguments.study, translated=False)
    beside = find(arguments.study).parent / f"{language}.toml"
    out = arguments.out or beside
    if out.exists():
        raise InputError(
            f"{out}: exists already; expected a new file: --out FILE, with what is in it taken over"
        )
    before: dict[str, str] = {}
    changed: dict[str, str] = {}
    if beside.exists():
        data = read_regular(beside, LARGEST_TEXT)
        try:
            before = flat(parse_toml(data, str(beside)))
        except TypeError as error:
            raise InputError(f"{beside}: {error}") from None
        changed = stale(study, before, data)
    texts = needed(study)
    missing = sum(not before.get(key, "") for key in texts) + len(changed)
    try:
        out.write_text(template(study, before, changed), "utf-8")
    except OSError as error:
        raise InputError(f"{out}: cannot be written: {error.strerror}") from None
    again = f", {len(changed)} of them again: the study has other words now" if changed else ""
    print(f"{out}: {len(texts)} texts, {missing} to be filled in{again}")
    print(
        f'then, in the study: language = "{out.name}" below [study]; `check` says what is missing'
    )
    return 0
