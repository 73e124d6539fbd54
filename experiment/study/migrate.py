"""The language of earlier versions made into the present one: in memory for records, and as a file
that keeps its comments (`seethrough migrate`).

A study of then crossed `transparency` with the scenarios that its tasks live in.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

OLD_TABLES = {"abstract": "world", "walkthrough": "world", "dynamic": "technique"}
NAMES = {"abstract": "abstract", "walkthrough": "building", "dynamic": "dynamic"}
OLD_KEYS = {
    "design": ("transparency", "training"),
    "session": ("training_limit", "trial_limit", "session_limit", "consent", "demographics",
                "color_check", "questionnaire"),
}  # fmt: skip
SCENARIOS = {
    "abstract": ("count", "pattern"),
    "walkthrough": ("unique", "count_in_building"),
}
LEVELS = ("standard", "dynamic")
QUESTIONNAIRE = ("ratings", "comparison", "remarks")
START = ("consent", "demographics", "color_check")


Tables: TypeAlias = dict[str, dict[str, object]]  # a part of a study
Factors: TypeAlias = dict[str, dict[str, dict[str, Tables]]]  # name → "levels" → level → its part


def is_old(table: Mapping[str, object]) -> bool:
    """Whether a study's table is in the language of earlier versions."""
    if any(name in table for name in ("factors", "technique", "world", "questions")):
        return False
    tables = any(name in table for name in OLD_TABLES)
    for name, keys in OLD_KEYS.items():
        own = table.get(name)
        if isinstance(own, Mapping) and any(key in own for key in keys):
            return True
    return tables


def migrated(table: Mapping[str, object]) -> dict[str, object]:
    """The same study in the present language."""
    new: Tables = {k: dict(v) for k, v in table.items() if isinstance(v, Mapping)}
    plain = {k: v for k, v in table.items() if k not in new}  # wrong, and refused later
    design, session = new.setdefault("design", {}), new.setdefault("session", {})
    factors, base = factors_of(design)
    for name, key in OLD_TABLES.items():
        if name in new:
            new.setdefault(key, {})[NAMES[name]] = new.pop(name)
    for key, part in base.items():
        new.setdefault(key, {}).update(part)
    for table_, key, old in (
        ("practice", "trials", design.pop("training", None)),
        ("practice", "limit", session.pop("training_limit", None)),
        ("task", "limit", session.pop("trial_limit", None)),
        ("session", "limit", session.pop("session_limit", None)),
    ):
        if old is not None:
            new.setdefault(table_, {})[key] = old
    if "scenario" not in factors and design.get("redraw"):
        old_, world = next((o, n) for o, n in NAMES.items() if n == base["world"]["use"])
        design["redraw"] = [
            f"{world}{name.removeprefix(old_)}" if name.startswith(f"{old_}-") else name
            for name in _texts(design["redraw"])
        ]
    questions = questions_of(session, factors)
    return {**new, **plain, "questions": questions, **({"factors": factors} if factors else {})}


def _texts(said: object) -> list[str]:
    """The texts of an array; what is none becomes one, and is refused as what it should name."""
    return [str(name) for name in said] if isinstance(said, list | tuple) else [str(said)]


def factors_of(design: dict[str, object]) -> tuple[Factors, Tables]:
    """The factors of a [design] of then, and what the base has where one would have one level;
    both are taken out of it."""
    levels = _texts(design.pop("transparency", None) or LEVELS)
    every = [t for own in SCENARIOS.values() for t in own]
    tasks = _texts(design.pop("tasks", None) or every)
    factors: Factors = {}
    base: Tables = {}
    if len(levels) > 1:
        named: dict[str, Tables] = {level: {"technique": {"use": level}} for level in levels}
        factors["transparency"] = {"levels": named}
    else:
        base["technique"] = {"use": levels[0]}
    worlds: dict[str, Tables] = {}
    for scenario, own in SCENARIOS.items():
        there = [task for task in tasks if task in own]
        if there or any(task not in sum(SCENARIOS.values(), ()) for task in tasks):
            worlds[scenario] = {"world": {"use": NAMES[scenario]}, "design": {"tasks": there}}
    if len(worlds) > 1:
        factors["scenario"] = {"levels": worlds}
    else:
        for part in worlds.values():
            base |= part
    return factors, base


def questions_of(session: dict[str, object], factors: Factors) -> dict[str, object]:
    """The pages of a [session] of then, taken out of it."""
    named: dict[str, object] = {}
    consent = session.pop("consent", "")
    if consent:
        named["consent"] = {"when": "start", "file": consent}
    for name in START[1:]:
        if session.pop(name, False):
            named[name] = {"when": "start"}
    for name in _texts(session.pop("questionnaire", QUESTIONNAIRE)):
        if name == "comparison" and "transparency" not in factors:
            continue  # one level is not compared
        named[name] = {"when": "end", **_of_levels(name, factors)}
    return named


def _of_levels(name: str, factors: Factors) -> dict[str, object]:
    """For which levels a page of then was asked."""
    if name == "comparison":
        return {"of": "transparency"}
    if name == "depth_test" and "transparency" in factors:
        return {"only": {"transparency": "dynamic"}}
    if name == "ratings":
        return {"each": list(factors)}
    if name in ("tlx", "sus"):
        return {"each": [f for f in factors if f == "transparency"]}
    return {}
