"""A study's preregistration as Markdown: what is decided before there are data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from seethrough.experiment.study.selection import said as rule_of
from seethrough.experiment.study.shown.described import design_entry, each_of, items_of
from seethrough.experiment.study.shown.design_table import lines_of
from seethrough.experiment.study.study import Study

RULES = {
    "timed_out": "trials that ended at their time limit",
    "focus_lost": "trials during which the window lost the focus",
    "frames_missed": "trials in which frames were missed",
    "too_fast": "trials answered sooner than {too_fast:g} s",
}
EXPECTED = {
    "less": "is less than at the baseline",
    "more": "is more than at the baseline",
    "different": "differs from the baseline",
    "not worse": "is not worse than at the baseline",
    "equivalent": "is equivalent to the baseline",
    "at least": "is at least",
}


def preregistration(study: Study) -> str:
    """The text; what a study leaves open is said to be open."""
    entry = design_entry(study)
    parts = [
        f"# Preregistration: {study.general.title}",
        study.general.description,
        f"Made by `seethrough prereg` from the study `{study.general.name}`, whose SHA-256 is "
        f"`{study.digest()}`. Every session's record has the same hash, or was another study.",
        "## Design",
        "```text\n" + "\n".join(lines_of(study, study.general.participants)) + "\n```",
        *_selected(study),
        "Who drops out is replaced by somebody in the same row of the design; sessions end at "
        f"{study.session.limit / 60:g} minutes.",
        "## Measures",
        *_measures(entry),
        "## Questions",
        _questions(study),
        "## Predictions",
        *_predictions(study, entry),
        "## Planned tests",
        _tests(study),
        "## Exclusions",
        *_exclusions(study),
        "## Sample size",
        f"{study.general.participants} people. `seethrough power` says what they can find: paste "
        "its table here where it was run; none is part of the study's file.",
    ]
    return "\n\n".join(parts) + "\n"


def _selected(study: Study) -> list[str]:
    rule = rule_of(study)
    return [f"Scenes are selected, by a rule that is declared here: {rule}."] if rule else []


def _measures(entry: Mapping[str, Any]) -> Iterator[str]:
    rows = ["| task | measure | unit | better | a person's trials | margin |",
            "| --- | --- | --- | --- | --- | --- |"]  # fmt: skip
    for task in entry["tasks"]:
        for m in task["measures"]:
            margin = "none" if m["margin"] is None else f"{m['margin']:g}"
            adds = f"{m['adds']}{' of logarithms' if m['log'] else ''}"
            label = m["label"] or m["name"]
            rows.append(f"| {task['code']} {task['name']} | {label} (`{m['name']}`) | {m['unit']} "
                        f"| {m['direction']} | {adds} | {margin} |")  # fmt: skip
    yield "\n".join(rows)


def _questions(study: Study) -> str:
    """What is asked besides the tasks, when, for which levels, with the items' points."""
    rows = ["| question | kind | asked | once for each | items |",
            "| --- | --- | --- | --- | --- |"]  # fmt: skip
    for name, asked in study.questions.items():
        items = []
        for item in items_of(study, name, asked):
            low, points = item.get("low"), item.get("points")
            scale = ""
            if isinstance(low, int) and isinstance(points, int):
                scale = f" ({low} to {low + points - 1})"
            reverse = item.get("reverse")
            turned = ", ".join(f"`{t}`" for t in reverse) if isinstance(reverse, list) else ""
            items.append(f"`{item['name']}`{scale}" + (f", turned: {turned}" if turned else ""))
        each = " × ".join(each_of(study, asked)) or "session"
        when = asked.when_asked.replace("_", " ")
        said = "; ".join(items) or "no scale"
        rows.append(f"| {name} | {asked.use} | {when} | {each} | {said} |")
    return "\n".join(rows) if study.questions else "Nothing is asked besides the tasks."


def _predictions(study: Study, entry: Mapping[str, Any]) -> Iterator[str]:
    if not entry["predictions"]:
        yield "None is stated: every comparison is exploratory."
        return
    yield "\n".join(_prediction(study, said) for said in entry["predictions"])
    yield (
        "Stated predictions are one family: Holm's correction over those of which any has to hold, "
        "the largest p over those that all have to."
    )


def _prediction(study: Study, said: Mapping[str, Any]) -> str:
    """A line: what is expected of which measure, against what, by how much."""
    measures = [said["measure"]] if isinstance(said["measure"], str) else said["measure"]
    line = f"- **{said['name']}**: {', '.join(f'`{m}`' for m in measures)}"
    line += f" {EXPECTED[said['expect']]}"
    if "value" in said:
        line += f" {said['value']:g}"
    if said.get("contrast"):
        line += f" ({said['contrast']}: {study.factor(said['contrast']).baseline})"
    if said.get("margin"):
        margin = said["margin"]
        each = margin if isinstance(margin, Mapping) else {"": margin}
        line += ", by a margin of " + ", ".join(f"{v:g} {m}".strip() for m, v in each.items())
    if said.get("ratio"):
        line += f", by a ratio of {said['ratio']:g}"
    return line + (f"; {said['combine']} of them." if len(measures) > 1 else ".")


def _tests(study: Study) -> str:
    analysis = study.analysis
    tests = ", ".join(analysis.tests) or "all sections of the report"
    said = (f"{tests}, at a level of significance of {analysis.alpha:g}. Predictions are tested by "
            "planned contrasts against the baseline, each with its own error term; omnibus tests "
            "are exploratory.")  # fmt: skip
    if analysis.pairwise:
        said += f" Every pair of levels is compared of {', '.join(analysis.pairwise)}, by Holm."
    if analysis.aligned_ranks:
        said += " Interactions of ordinal measures are tested by aligned ranks, too."
    return said


def _exclusions(study: Study) -> Iterator[str]:
    rules = study.analysis.exclude
    if not rules:
        yield "Nothing is left out."
        return
    lines = []
    for rule in rules:
        said = RULES.get(rule, f"participant {rule.partition(':')[2]}")
        lines.append(f"- {said.format(too_fast=study.analysis.too_fast)}")
    yield "\n".join(lines)
