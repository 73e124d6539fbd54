"""What is put into `seethrough power`: an assumed effect, printed ones, or people of a folder."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, inf, log, sqrt
from pathlib import Path

import numpy as np

from seethrough.analysis.design import Design
from seethrough.analysis.load.sidecar_design import read_design
from seethrough.analysis.published.numbers import PublishedMeasure, load_published
from seethrough.analysis.sections.tests.measured import OVERALL
from seethrough.experiment.errors import InputError
from seethrough.experiment.power.closed import interval_of, needed
from seethrough.experiment.power.decisions import Planned, Test, run
from seethrough.experiment.power.planned import Plans, Score, groups_of, plans_of
from seethrough.experiment.power.power import implied_r
from seethrough.experiment.power.sources import Normal, Sampled, Source
from seethrough.experiment.study.config import Study, load
from seethrough.experiment.study.shown.described import design_entry
from seethrough.renderer.meant import one_of

GIVEN = re.compile(r"\s*([^=]+?)\s*=\s*([-+]?\d*\.?\d+)\s*(\S.*?)\s*")


@dataclass(frozen=True)
class Put:
    """A test as it was put in: its true estimate in words, standardised (noncentrality over √n, in
    the predicted direction), the n for 80 %, and its interval where people were few."""

    test: Test
    said: str
    delta: float
    n: float
    interval: tuple[float, float] | None


@dataclass(frozen=True, eq=False)
class Effect:
    """Where the people come from. `drawn` and `assumed` stand on top of every answer; `alone`: what
    of the study is not asked, and why."""

    planned: tuple[Planned, ...]
    source: Source
    truth: Mapping[str, float]
    put: tuple[Put, ...]
    drawn: str
    assumed: str
    alone: tuple[str, ...]


def design_of(study: Study) -> Design:
    """The study's design as its sidecars will say it."""
    entry = json.loads(json.dumps(design_entry(study)))
    return read_design(entry, study.general.name)


def effect_of(study: Study, text: str, spread: float | None, source: str | None) -> Effect:
    """The effect that `--effect` names. Raises InputError."""
    design = design_of(study)
    plans = plans_of(design)
    if not plans.planned:
        lines = "; ".join(plans.left_out) or "it has no factor within or between people"
        raise InputError(f"power of {study.general.name}: nothing is tested: {lines}")
    if text == "published":
        return _published(design, plans, study.analysis.alpha)
    if match := GIVEN.fullmatch(text):
        name, value, unit = match[1], float(match[2]), match[3]
        return _given(design, plans, (name, value, unit), spread, study.analysis.alpha)
    folder = Path(text)
    if not folder.is_dir():
        raise InputError(
            f'--effect = {text}: expected "PREDICTION=0.2 sd", published, or a data folder'
        )
    return _folder(folder, source, design, plans, study.analysis.alpha)


def _given(
    design: Design, plans: Plans, given: tuple[str, float, str], spread: float | None, alpha: float
) -> Effect:
    """Normal differences of that size, in every test of a prediction or of a factor's."""
    name, value, unit = given
    about = {p.name for p in design.predictions if name in (p.name, p.contrast)}
    chosen = [p for p in plans.planned if p.name in about or name == p.name]
    if not design.predictions:
        chosen = [p for p in plans.planned if name in _factors(plans, p)]
    if not chosen:
        known = sorted({n for p in design.predictions for n in (p.name, p.contrast) if n}
                       | {c.factor for c in design.contrasts()})  # fmt: skip
        raise InputError(f"--effect = {name}: expected {one_of(name, known)}")
    groups, k = groups_of(design), len(plans.scores)
    means, sds = np.zeros((len(groups), k)), np.ones((len(groups), k))
    for test in {t for p in chosen for t in p.tests}:
        score = plans.scores[test.column]
        size, sd = _size(test, value, unit, spread)
        sign = test.sign or 1.0
        sds[:, [test.column, *(p.column for p in test.parts)]] = sd
        if score.contrast is not None and score.contrast.between:
            for g, group in enumerate(groups):
                if group[score.contrast.factor] == score.contrast.baseline:
                    means[g, test.column] = sign * size
        elif score.contrast is not None and score.first == 1.0:
            means[:, test.column] = sign * size
        else:
            raise InputError(f"--effect = {name}: {test.name}: expected a difference of two levels")
    source = Normal(means, sds, (1 / len(groups),) * len(groups))
    spread_said = "" if unit == "sd" else f" with s.d. {spread:g} {unit}"
    assumed = (
        f"In each test of {', '.join(p.name for p in chosen)} a difference is taken to be "
        f"normal{spread_said} and {value:g} {unit} on average in the predicted direction; tests "
        "are taken to be independent."
    )
    drawn = "Nothing is drawn from this study's scenes."
    return _effect(tuple(chosen), plans, source, alpha, drawn, assumed, None)


def _factors(plans: Plans, planned: Planned) -> set[str]:
    """The factors whose levels a prediction compares."""
    contrasts = [plans.scores[test.column].contrast for test in planned.tests]
    return {contrast.factor for contrast in contrasts if contrast is not None}


def _size(test: Test, value: float, unit: str, spread: float | None) -> tuple[float, float]:
    """(difference, s.d.) of scores."""
    if unit == "sd":
        return value, 1.0
    if unit not in ("%", test.unit) or (unit == "%" and not test.log):
        known = "sd or %" if test.log else f"sd or {test.unit}" if test.unit else "sd"
        raise InputError(f"--effect: {value:g} {unit}: {test.name}: expected {known}")
    if spread is None or spread <= 0:
        raise InputError(
            f"--effect: {value:g} {unit}: expected --spread S as well, the s.d. of one person's "
            f"differences in {unit}"
        )
    if not test.log:
        return value, spread
    if unit != "%" or not value < 100:
        raise InputError(f"--effect: {value:g} {unit}: {test.name}: expected % below 100")
    return -log(1 - value / 100), log(1 + spread / 100)


def _published(design: Design, plans: Plans, alpha: float) -> Effect:
    """Normal scores with the printed moments; of times those of lognormal ones."""
    theirs = design_of(load("published"))
    if design.tasks != theirs.tasks or design.factors != theirs.factors:
        raise InputError(
            "--effect = published: expected the published study's factors and tasks: its numbers "
            "say nothing of others"
        )
    found = [_printed(design, score) for score in plans.scores]
    kept, gone = [], list(plans.left_out)
    for planned in plans.planned:
        there = tuple(t for t in planned.tests if found[t.column] is not None)
        gone += [f"{planned.name}: {t.name}: the paper prints no numbers of it"
                 for t in planned.tests if t not in there]  # fmt: skip
        if there:
            kept.append(replace(planned, tests=there))
    moments = np.array([m or (0.0, 1.0) for m in found])
    source = Normal(moments[None, :, 0], moments[None, :, 1])
    drawn = (
        "Nothing is drawn from scenes: scores are normal with the paper's printed means and s.d. "
        "and the correlation that each printed F implies (Elmqvist2009, tables 3 and 4)."
    )
    assumed = (
        "Times are assumed lognormal with those moments, because the report decides by logarithms; "
        "measures are assumed to be independent of one another; these are 16 people's numbers, "
        "taken as if they were the truth."
    )
    effect = _effect(tuple(kept), plans, source, alpha, drawn, assumed, 16)
    return replace(effect, alone=tuple(gone))


T2_SD = 0.146  # of differences of shares right, of the only 16 people that fit what is printed


def _printed(design: Design, score: Score) -> tuple[float, float] | None:
    """Mean and s.d. of a score, if the paper prints what it takes."""
    numbers = load_published()
    if score.item:
        single = next((s for s in numbers.single if s.name == score.item), None)
        return (single.moments.mean.value, single.moments.sd.value) if single else None
    assert score.measure is not None
    task = design.task(score.where)
    code = OVERALL if score.where == OVERALL else task.code if task else ""
    named = {"time": "time", "count_error": "error", "distance": "distance"}
    name = f"{named.get(score.measure.name, '')}_{code}"
    if score.measure.name == "correct" and code == "T2":
        return 0.0, T2_SD
    printed = next((m for m in numbers.measures if m.name == name), None)
    return None if printed is None else _of_printed(printed, score.measure.log, 16)


def _of_printed(m: PublishedMeasure, logs: bool, n: int) -> tuple[float, float]:
    means = (m.standard.mean.value, m.dynamic.mean.value)
    sds = (m.standard.sd.value, m.dynamic.sd.value)
    r = implied_r(means, sds, m.f.value, n)
    if not logs:
        return means[0] - means[1], sqrt(sds[0] ** 2 + sds[1] ** 2 - 2 * r * sds[0] * sds[1])
    ratio = [s / mean for s, mean in zip(sds, means, strict=True)]
    spread = [log(1 + x * x) for x in ratio]
    middle = [log(mean) - s / 2 for mean, s in zip(means, spread, strict=True)]
    both = log(1 + r * ratio[0] * ratio[1])
    return middle[0] - middle[1], sqrt(spread[0] + spread[1] - 2 * both)


def _folder(folder: Path, source: str | None, design: Design, plans: Plans, alpha: float) -> Effect:
    """People of a folder of this study, drawn whole, with replacement."""
    from seethrough.experiment.power.power_data import context_of, sampled

    context = context_of(folder, source, design)
    people, _ = sampled(context, plans)
    kind = context.study.source
    drawn = (
        f"{people.people} {kind} participants of {folder.name} are drawn whole, with replacement, "
        "within their group: their own trials in this study's scenes, with its exclusions and time "
        "limit, reduced as its report reduces them."
    )
    assumed = (
        "They are taken as if they were everybody; the interval of n carries the doubt that so few "
        "leave."
    )
    if kind == "simulated":
        assumed += (
            " Simulated people are a tool for planning, never evidence: what decides is how much "
            "each condition shows, and what the model assumes of people."
        )
    if people.people < 5000:
        assumed += " Type S and M of fewer than 5,000 people are rough."
    return _effect(tuple(plans.planned), plans, people, alpha, drawn, assumed, people.people)


def _effect(
    planned: tuple[Planned, ...], plans: Plans, source: Source, alpha: float, drawn: str,
    assumed: str, people: int | None,
) -> Effect:  # fmt: skip
    tests = {t.name: t for p in planned for t in p.tests}
    put = [_put(t, source, alpha, people) for t in tests.values()]
    truth = {p.test.name: _truth(p.test, source) for p in put}
    return Effect(planned, source, truth, tuple(put), drawn, assumed, tuple(plans.left_out))


def _moments(test: Test, source: Source, column: int) -> tuple[float, float]:
    """ψ and √n times its standard error, of the population that is drawn from."""
    value, variance = 0.0, 0.0
    for g, (weight, share) in enumerate(zip(test.weights, source.shares, strict=True)):
        if isinstance(source, Normal):
            mean, sd = float(source.means[g, column]), float(source.sds[g, column])
        else:
            assert isinstance(source, Sampled)
            own = source.scores[g][:, column]
            own = own[np.isfinite(own)]
            mean, sd = float(own.mean()), float(own.std(ddof=1))
        value += weight * mean
        variance += weight**2 * sd**2 / share
    return value, sqrt(variance)


def _truth(test: Test, source: Source) -> float:
    return _moments(test, source, test.column)[0]


def _put(test: Test, source: Source, alpha: float, people: int | None) -> Put:
    """A test's own effect, standardised, and what it takes to find it."""
    value, spread = _moments(test, source, test.column)
    said = _said(test, value)
    if test.ranked and test.directed:
        return Put(test, said, 0.0, inf, None)
    if test.directed:
        sides, sign = 2, test.sign or (1.0 if value >= 0 else -1.0)
        deltas = [sign * value / spread] if spread else [0.0]
    else:
        deltas, sides = [], 1
        for part in test.parts:
            own, sd = _moments(test, source, part.column)
            deltas.append((part.sign * own + part.shift) / sd if sd else inf)
    delta = min(deltas)
    if delta == inf:
        return Put(test, said, inf, 3, None)
    interval = None
    if people is not None:
        low, high = interval_of(delta, people, people - len(test.weights))
        interval = (needed(high, alpha, sides), needed(low, alpha, sides))
    return Put(test, said, delta, needed(delta, alpha, sides), interval)


def _said(test: Test, value: float) -> str:
    if test.log:
        return f"ratio {exp(-value):.3g}"
    if test.single:
        return f"{value:.3g}"
    return f"{0.0 - value:+.3g} {test.unit}".strip()


def smallest(effect: Effect, n: int, alpha: float) -> Sequence[tuple[Test, float, str]]:
    """The smallest effect that n people would show in 80 % of studies, of each two-sided t test."""
    from seethrough.analysis.stats.distributions import detectable
    from seethrough.experiment.power.closed import ENOUGH

    found = []
    for put in effect.put:
        if put.test.ranked or not put.test.directed:
            continue
        least = detectable(n, alpha, ENOUGH)
        spread = _moments(put.test, effect.source, put.test.column)[1]
        sign = put.test.sign or 1.0
        found.append((put.test, least, _said(put.test, sign * least * spread)))
    return found


def decisions(effect: Effect) -> Mapping[str, float]:
    """p of every test in the people as they are: what their own report prints (for tests)."""
    assert isinstance(effect.source, Sampled)
    groups = [own[None] for own in effect.source.scores]
    return {p.test.name: float(run(p.test, groups).p[0]) for p in effect.put}
