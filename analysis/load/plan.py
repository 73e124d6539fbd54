"""What the study decided before collecting data, and where this report departs from it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from seethrough.analysis.before import planned_trials
from seethrough.analysis.errors import DataError, number_above
from seethrough.analysis.exclude import TOO_FAST
from seethrough.analysis.load.study import Study, config_of

TESTS = ("time", "accuracy", "ratings", "tradeoff", "validity", "mixed")


@dataclass(frozen=True, slots=True)
class Plan:
    """The analysis as it runs. `frozen` is the study's [analysis] table, None if it has none.

    `margins`: what the study declared to be no difference that matters, by measure; what is not in
    it has no margin. `too_fast`: the limit of that exclusion rule, seconds. `pairwise`: factors of
    which every pair of levels is compared; `aligned_ranks`: whether they were asked for.
    """

    alpha: float
    exclude: tuple[str, ...]
    tests: tuple[str, ...]
    margins: Mapping[str, float]
    frozen: Mapping[str, object] | None
    deviations: tuple[str, ...]
    participants: int | None
    trials: int | None
    too_fast: float = TOO_FAST
    pairwise: tuple[str, ...] = ()
    aligned_ranks: bool = False


def digest(value: object) -> str:
    """A short hash that does not depend on the order of keys."""
    text = json.dumps(value, sort_keys=True, ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def make_plan(
    study: Study,
    alpha: float | None = None,
    exclude: Sequence[str] | None = None,
    pairwise: Sequence[str] = (),
    aligned_ranks: bool = False,
) -> Plan:
    """The frozen plan, with what was asked on the command line instead or beside, listed as
    deviations. Raises DataError."""
    configs = [config_of(sidecar) for sidecar in study.sidecars.values()]
    frozen = _first(configs, "analysis")
    table = frozen or {}
    planned_alpha = number_above("alpha", table.get("alpha", 0.05), 0)
    planned_out = _texts("exclude", table)
    used_alpha = planned_alpha if alpha is None else alpha
    used_out = planned_out if exclude is None else tuple(exclude)
    if not 0 < used_alpha < 1:
        raise DataError(f"alpha = {used_alpha}: expected a number between 0 and 1")
    pairs = tuple(dict.fromkeys([*_texts("pairwise", table), *pairwise]))
    for name in pairs:
        if name not in study.design.levels:
            known = ", ".join(study.design.levels) or "no factor"
            raise DataError(f"analysis.pairwise = {name!r}: expected among {known}")
    tests = _texts("tests", table)
    unknown = [t for t in tests if t not in TESTS]
    if unknown:
        raise DataError(f"analysis.tests = {unknown[0]!r}: expected among {', '.join(TESTS)}")
    design, about = _first(configs, "design") or {}, _first(configs, "study") or {}
    deviations = [
        *_choices(frozen, (planned_alpha, used_alpha), (planned_out, used_out)),
        *_further(
            [name for name in pairwise if name not in _texts("pairwise", table)],
            aligned_ranks and table.get("aligned_ranks") is not True,
        ),
        *_collection(study, configs, design, about),
    ]
    return Plan(
        used_alpha,
        used_out,
        tests or TESTS,
        {m.name: m.margin for m in study.design.measures() if m.margin is not None},
        frozen,
        tuple(deviations),
        _whole(about.get("participants")),
        _whole(design.get("trials")),
        number_above("too_fast", table.get("too_fast", TOO_FAST), 0),
        pairs,
        aligned_ranks or table.get("aligned_ranks") is True,
    )


def _first(configs: Sequence[Mapping[str, object]], name: str) -> Mapping[str, object] | None:
    """The table of the first config that has it."""
    found = (c[name] for c in configs if name in c)
    return next((table for table in found if isinstance(table, Mapping)), None)


def _texts(name: str, table: Mapping[str, object]) -> tuple[str, ...]:
    found = table.get(name, ())
    if not isinstance(found, list | tuple) or not all(isinstance(x, str) for x in found):
        raise DataError(f"analysis.{name} = {found!r}: expected an array of texts")
    return tuple(found)


def _whole(value: object) -> int | None:
    """A number of people or trials, None where the config says none."""
    return value if isinstance(value, int) else None


def _further(new: Sequence[str], aligned: bool) -> list[str]:
    """Tests that were asked for with the report, not planned."""
    lines = [f"All pairs of {', '.join(new)} were not planned; they were asked for."] if new else []
    if aligned:
        lines.append("Aligned ranks were not planned; they were asked for.")
    return lines


def _choices(
    frozen: Mapping[str, object] | None,
    alpha: tuple[float, float],
    exclude: tuple[tuple[str, ...], tuple[str, ...]],
) -> list[str]:
    """Departures chosen for this report."""
    if frozen is None:
        return []
    lines = []
    if alpha[0] != alpha[1]:
        lines.append(f"alpha is {alpha[1]:g}, planned was {alpha[0]:g}.")
    if exclude[0] != exclude[1]:
        used, planned = (", ".join(x) or "none" for x in (exclude[1], exclude[0]))
        lines.append(f"Exclusion rules are: {used}; planned were: {planned}.")
    return lines


def _collection(
    study: Study,
    configs: Sequence[Mapping[str, object]],
    design: Mapping[str, object],
    about: Mapping[str, object],
) -> list[str]:
    """Departures that happened while data were collected."""
    lines = []
    kinds = {digest({k: v for k, v in c.items() if k != "texts"}) for c in configs if c}
    if len(kinds) > 1:
        lines.append(f"Participants ran with {len(kinds)} different configs.")
    count = study.trials["participant"].nunique()
    planned = about.get("participants")
    if isinstance(planned, int) and planned != count:
        have = "1 participant has" if count == 1 else f"{count} participants have"
        lines.append(f"{have} data, planned were {planned}.")
    trials = planned_trials(design)
    return lines if trials is None else [*lines, *_short(study, trials)]


def _short(study: Study, planned: int) -> list[str]:
    """Participants with another number of trials than planned; repeated ones count once."""
    keys = ["participant", "trial"]
    sizes = study.trials.drop_duplicates(keys).groupby("participant", observed=True).size()
    odd = sizes[sizes != planned]
    if not len(odd):
        return []
    named = ", ".join(f"{name} ({size})" for name, size in odd[:20].items())
    more = f" and {len(odd) - 20} more" if len(odd) > 20 else ""
    return [f"Of {planned} planned trials each, other numbers were recorded for {named}{more}."]
