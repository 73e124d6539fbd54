"""The questionnaire after the trials (004 §VI-G): ratings per condition, preference, depth."""

from __future__ import annotations

from collections.abc import Mapping

from experiment.config import Study
from experiment.display import Input
from experiment.pages import Choice, Page, Scale, TextField

RATINGS = ("efficiency", "ease", "enjoy")


def ask(study: Study, participant: Input) -> list[Mapping[str, str]]:
    """Ask every page; rows of the questionnaire table, without who and where."""
    rows: list[Mapping[str, str]] = []
    for transparency, scenario in study.design.factors().conditions:
        page = _ratings(transparency, scenario)
        answers = participant.ask(page)
        rows += [
            _row(item, answers[item], transparency=transparency, scenario=scenario)
            for item in RATINGS
        ]
    if len(study.design.transparency) > 1:
        answers = participant.ask(_comparison())
        rows.append(_row("preference", str(int(answers["preference"] == "0"))))
        rows.append(_row("depth_self_report", answers["depth_self_report"]))
    answers = participant.ask(
        Page("remarks", "remarks.title", (TextField("remarks", "remarks.text"),))
    )
    if answers.get("remarks"):
        rows.append(_row("remarks", "", text=answers["remarks"]))
    return rows


def _ratings(transparency: str, scenario: str) -> Page:
    values = (("transparency", f"name.{transparency}"), ("scenario", f"name.{scenario}"))
    scales = tuple(
        Scale(item, f"rating.{item}", "rating.low", "rating.high", values=values)
        for item in RATINGS
    )
    return Page(f"rating {transparency} {scenario}", f"rating.{transparency}.{scenario}", scales)


def _comparison() -> Page:
    return Page(
        "comparison",
        "comparison.title",
        (
            Choice(
                "preference",
                "comparison.preference",
                ("name.dynamic", "name.neutral", "name.standard"),
            ),
            Scale("depth_self_report", "comparison.depth", "rating.low", "rating.high"),
        ),
    )


def _row(item: str, value: str, **more: str) -> Mapping[str, str]:
    return {"item": item, "value": value, **more}
