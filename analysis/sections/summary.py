"""The first page: the study's predictions, answered by name in plain sentences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from seethrough.analysis.design import Contrast, Design, Prediction
from seethrough.analysis.page.blocks import Cited, Column, Prose, Section, Table, say
from seethrough.analysis.sections.answers.answers import Answer
from seethrough.analysis.sections.answers.answers_directed import faster
from seethrough.analysis.sections.answers.answers_margin import accurate
from seethrough.analysis.sections.answers.answers_other import at_least, compared
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.participants import reach, reach_sentence
from seethrough.analysis.sections.scales import Tables

PLANNING = " (simulated participants)"
SELECTED = (
    "Scenes selected, by a rule that the study declared: {}. What is found holds for such scenes, "
    "and says nothing of others."
)
VERDICTS = (
    Column("prediction", "prediction"),
    Column("said", "what was predicted"),
    Column("expect", "expected"),
    Column("combine", "of its tests"),
    Column("tests", "tests", "int"),
    Column("p", "p", "p", "that decides"),
    Column("verdict", "verdict"),
)


@dataclass(frozen=True, slots=True)
class Found:
    """What the sections found: each measure's tables, and the items that were asked once."""

    tables: Tables
    single: Table | None

    def speed(self, design: Design) -> Table | None:
        """The contrasts of the first measure that is analysed as logarithms."""
        own = next((self.tables.get(m.name, {}) for m in design.measures() if m.log), {})
        return own.get("logs")


def summary_section(context: Context, found: Found) -> Section:
    """Each prediction by name; what was not predicted is exploratory; then where numbers are."""
    note = PLANNING if context.study.source == "simulated" else ""
    predictions = context.design.predictions
    answers = [_answer(context, p, found, note) for p in predictions]
    words = {p.name: p.said or _words(context, p) for p in predictions}
    blocks: list[Prose] = [*_few(context), *(a.said for a in answers)]
    said = (
        "Everything below that answers none of these predictions is exploratory."
        if predictions
        else "The study stated no prediction: everything below is exploratory."
    )
    blocks.append(say(said, kind="note"))
    if context.design.selected:
        blocks.append(say(SELECTED, context.design.selected, kind="note"))
    tables = [_verdicts(answers, words)] if answers else []
    return Section("summary", "In short", (*blocks, *places(blocks), *tables))


def _answer(context: Context, prediction: Prediction, found: Found, note: str) -> Answer:
    """By what a prediction expects."""
    start = f"{prediction.name}, {prediction.said or _words(context, prediction)}{note}: "
    if prediction.expect == "at least":
        return at_least(context, prediction, found.single, start)
    if prediction.expect == "not worse":
        return accurate(context, prediction, found.tables, start)
    measures = [m for m in context.design.measures() if prediction.about(m)]
    logs = found.tables.get(measures[0].name, {}).get("logs") if len(measures) == 1 else None
    contrasts = asked(context.design, prediction)
    if logs is not None and len(contrasts) == 1 and prediction.expect in ("less", "more"):
        return faster(context, prediction, found.tables[measures[0].name], contrasts[0], start)
    return compared(context, prediction, found.tables, contrasts, start)


def asked(design: Design, prediction: Prediction) -> tuple[Contrast, ...]:
    """The contrasts that a prediction is about: one level, or each against the baseline."""
    known = [c for c in design.contrasts() if c.factor == prediction.contrast]
    return tuple(c for c in known if prediction.level in ("", c.level))


def _words(context: Context, prediction: Prediction) -> str:
    """What a prediction says where the study gave it no text."""
    known: dict[str, str] = {}
    for measure in context.design.measures():
        known.setdefault(measure.column, measure.said)
    known |= {m.name: m.said for m in context.design.measures()}
    measures = ", ".join(known.get(n, n.replace("_", " ")) for n in prediction.measures)
    factor = next((f for f in context.design.factors if f.name == prediction.contrast), None)
    if factor is None:
        value = "" if prediction.value is None else f" {prediction.value:g}"
        return f"{measures} {prediction.expect}{value}"
    levels = prediction.level or " or ".join(c.level for c in factor.contrasts())
    how = {"less": "less with", "more": "more with", "not worse": "not worse with"}
    words = how.get(prediction.expect, f"{prediction.expect} with")
    than = "than" if prediction.expect in how else "and"
    return f"{measures} {words} {levels} {than} {factor.baseline} ({factor.name})"


def _verdicts(answers: Sequence[Answer], words: Mapping[str, str]) -> Table:
    rows = tuple(
        {
            "prediction": a.prediction.name,
            "said": words[a.prediction.name],
            "expect": a.prediction.expect,
            "combine": a.prediction.combine,
            "tests": a.tests,
            "p": a.p,
            "verdict": a.verdict,
        }
        for a in answers
    )
    note = (
        "Stated before the data. Of several tests, `all` is decided by the largest p, `any` by "
        "Holm's correction; predictions are not corrected for one another."
    )
    reasons = [
        f"{a.prediction.name}: {a.prediction.reason}" for a in answers if a.prediction.reason
    ]
    shown = tuple("prediction said tests p verdict".split())
    return Table("predictions", "Predictions", VERDICTS, rows, shown, " ".join([note, *reasons]))


def _few(context: Context) -> list[Prose]:
    """A warning where there are few participants."""
    if context.people == 1:
        return [
            say(
                "Only 1 participant: nothing can be tested. From two on, this report compares "
                f"{_levels(context)}, with intervals, tests and sizes of effects.",
                kind="warning",
            )
        ]
    found = reach(context)
    said = reach_sentence(found) if found else None
    return [said] if said is not None and said.kind == "warning" else []


def _levels(context: Context) -> str:
    """What a report of several people compares: `time, distance by transparency`."""
    measures = ", ".join(m.said for m in context.design.measures())
    factors = " and ".join(f.name for f in context.design.factors)
    return f"{measures} by {factors}" if factors else measures


def places(blocks: Sequence[Prose]) -> list[Prose]:
    """In which files and rows the numbers above are, at full precision."""
    rows: dict[str, list[str]] = {}
    for cited in (run for block in blocks for run in block.runs if isinstance(run, Cited)):
        own = rows.setdefault(cited.file, [])
        if cited.row not in own:
            own.append(cited.row)
    if not rows:
        return []
    said = "; ".join(
        f"tables/{file}, {'row' if len(own) == 1 else 'rows'} {', '.join(own)}"
        for file, own in rows.items()
    )
    return [
        say(
            f"Every number above stands at full precision in {said}. Point at a number anywhere "
            "in the text for its file, row and column.",
            kind="note",
        )
    ]
