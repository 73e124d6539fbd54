"""What questions call their items, and which answers others may wait for."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence

from seethrough.experiment.questions.kit import Foreseen, Possible
from seethrough.experiment.study.design.factors import Factor
from seethrough.experiment.study.tables.parameter_tables import MISSING, Fault
from seethrough.experiment.study.tables.question_table import Wanted
from seethrough.experiment.study.tables.reading import Question

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,63}")
NAMED = "a name of 1 to 64 letters (a–z), digits, _, . and -, a letter first"
TAKEN = ("participant", "slot")  # columns of every table that has one row a person


def unfit_names(factors: Sequence[Factor], items: Mapping[str, Sequence[str]]) -> Iterator[Fault]:
    """Names of tables and of their items (table → items) that cannot name a column of their own."""
    taken = {**dict.fromkeys(TAKEN, "every table"), **{f.name: "the factor" for f in factors}}
    for name, own in items.items():
        if not NAME.fullmatch(name):
            yield Fault(f"questions.{name}", name, NAMED)
            continue
        for item in dict.fromkeys(own):
            where = f"questions.{name}" + (".names" if item != name else "")
            if not NAME.fullmatch(item):
                yield Fault(where, item, NAMED)
            elif item in taken:
                yield Fault(where, item, f"another name: {taken[item]} has a column of that name")
            taken.setdefault(item, f"questions.{name}")


def unfit_parameters(name: str, question: Question, items: Sequence[str]) -> Iterator[Fault]:
    """What a kind cannot know alone: what its items are called, and what is compared."""
    where, p = f"questions.{name}", question.parameters
    for item in getattr(p, "reverse", ()):
        if item not in items:
            yield Fault(f"{where}.reverse", item, f"some of {', '.join(items)}"[:200])
    if getattr(p, "options", None) == () and not question.table.of:
        yield Fault(f"{where}.options", MISSING, "options, or `of` with a factor's name")


def unmet(name: str, item: str, wanted: Wanted, asked: Mapping[str, Question]) -> Iterator[Fault]:
    """What a question waits for that no answer to the item can be."""
    from seethrough.experiment.study.tables.ready import question  # pages: not for --help

    every = [
        kind.possible(q.parameters, item) if isinstance(kind, Foreseen) else None
        for q in asked.values()
        for kind in (question(q.use),)
    ]
    known = [one for one in every if one is not None]
    if known and len(known) == len(every):
        for one in wanted if isinstance(wanted, tuple) else (wanted,):
            if not any(_may_be(one, possible) for possible in known):
                yield Fault(f"questions.{name}.given.{item}", one, _said(known[0]))


def _may_be(wanted: str | float | Mapping[str, float] | object, possible: Possible) -> bool:
    low, high, texts = possible
    if isinstance(wanted, Mapping):
        return max(wanted.get("least", low), low) <= min(wanted.get("most", high), high)
    if isinstance(wanted, str):
        return wanted in texts or (_is_number(wanted) and low <= float(wanted) <= high)
    return isinstance(wanted, int | float) and low <= wanted <= high


def _is_number(text: str) -> bool:
    return re.fullmatch(r"-?\d{1,12}(\.\d{1,12})?", text) is not None


def _said(possible: Possible) -> str:
    low, high, texts = possible
    numbers = f"a number from {low:g} to {high:g}" if low <= high else ""
    names = f"one of {', '.join(sorted(texts))}"[:200] if texts else ""
    return "an answer that there can be: " + " or ".join(filter(None, (numbers, names)))
