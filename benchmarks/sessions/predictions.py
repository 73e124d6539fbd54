"""Which way do published comparisons go, and which way do simulated people go?

`seethrough bench predictions` plays the studies that this platform can build and whose results were
read, and counts directions; `python -m seethrough.benchmarks.sessions.predictions --out
docs/predictions.md` writes the page. What a comparison's simulated direction rests on is *derived*
from pixels (nothing in the model says what a technique is good for) or *assumed*. The list was
committed before it was run; nothing is left out; what the model's authors had read before they
wrote it is a *postdiction*.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import log
from pathlib import Path

import numpy as np

from seethrough.analysis.stats.paired import paired
from seethrough.analysis.stats.ranks import share_interval
from seethrough.analysis.stats.undefined import is_defined, number_in
from seethrough.benchmarks.rows import Row, row
from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.persons.profile_file import find
from seethrough.experiment.people.runs.data_mode import Row as Trial
from seethrough.experiment.people.runs.data_mode import play_session
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.people.runs.pool import drawing
from seethrough.experiment.study.config import load

PROFILE, PEOPLE, POOL, SEED = "calibrated", 32, 20, 7


@dataclass(frozen=True)
class Comparison:
    """A measure of `level` against `baseline`: what was published of it.

    `published`: less, more, or none (no difference was shown). `tasks`: those taken together.
    """

    study: str
    source: str
    factor: str
    level: str
    baseline: str
    measure: str
    tasks: tuple[str, ...]
    published: str
    basis: str = "derived"
    kind: str = "postdiction"


def _seed(measure: str, task: str, published: str) -> Comparison:
    return Comparison("published", "Elmqvist2009", "transparency", "dynamic", "standard", measure,
                      (task,), published)  # fmt: skip


def _liao(baseline: str) -> Comparison:
    return Comparison("liao2023", "Liao2023", "interface", "xray", baseline, "time",
                      ("count", "pattern"), "more", kind="prediction")  # fmt: skip


COMPARISONS = (
    _seed("time", "count", "less"),
    _seed("time", "pattern", "less"),
    _seed("time", "unique", "less"),
    _seed("time", "count_in_building", "less"),
    _seed("error", "count", "less"),
    _seed("error", "count_in_building", "none"),  # F = 4.12, p = .061
    _seed("correct", "pattern", "none"),
    _seed("distance", "unique", "none"),
    _liao("plain"),
    _liao("cutaway"),
)

# What was read and cannot be built here, and why.
NOT_BUILT = {
    "Liao2023, cutaway is poor where occluder and occludee are needed": "no task needs both",
    "Elmqvist and Tudoreanu 2007, navigation is fastest and most error-prone": "their transparency "
    "is a fisheye with scaling, their techniques are moved by hand (data mode refuses them)",
    "arXiv 2401.13341, no effect of the rendering, a strong one of the volume": "no volumes here",
}


@dataclass(frozen=True)
class Outcome:
    """What simulated people did: mean difference (level − baseline), its 95 % interval."""

    of: Comparison
    difference: float
    low: float
    high: float

    @property
    def direction(self) -> str:
        """less, more, or none where the interval holds 0."""
        return "less" if self.high < 0 else "more" if self.low > 0 else "none"

    @property
    def hit(self) -> bool:
        """Whether it went the published way."""
        return self.direction == self.of.published


def outcomes(people: int, pool: int, tables: Path | None, profile: str) -> Iterator[Outcome]:
    """Every comparison, study by study."""
    for study in dict.fromkeys(c.study for c in COMPARISONS):
        rows = _played(study, people, pool, tables, profile)
        for comparison in (c for c in COMPARISONS if c.study == study):
            yield _outcome(comparison, rows)


def _played(name: str, people: int, pool: int, tables: Path | None, profile: str) -> list[Trial]:
    study = load(name)
    scenes = drawing(study, pool, KeptLooks(tables))
    rows: list[Trial] = []
    for slot in study.plan.slots(people):
        rows += play_session(study, slot, SEED, scenes, find(profile)).trials
        scenes.looks.flush()
    return rows


def _outcome(comparison: Comparison, rows: Sequence[Trial]) -> Outcome:
    own = [r for r in rows if r["task"] in comparison.tasks]
    people = sorted({str(r["participant"]) for r in own})
    both = [
        [_value(comparison, own, person, level) for person in people]
        for level in (comparison.level, comparison.baseline)
    ]
    level, baseline = (np.array(values) for values in both)
    known = np.isfinite(level) & np.isfinite(baseline)
    found = paired(level[known], baseline[known])
    low, high = found.interval
    if not is_defined(low) or not is_defined(high):  # everybody alike
        return Outcome(comparison, found.difference, found.difference, found.difference)
    return Outcome(comparison, found.difference, float(low), float(high))


def _value(comparison: Comparison, rows: Sequence[Trial], person: str, level: str) -> float:
    """A person's value: mean log time, |Σ error| / Σ truth, mean distance or share right."""
    own = [r for r in rows if str(r["participant"]) == person and r[comparison.factor] == level]
    if not own:
        return float("nan")
    if comparison.measure == "time":
        return float(np.mean([log(number_in(r, "time")) for r in own]))
    if comparison.measure == "error":
        return abs(sum(number_in(r, "count_error") for r in own)) / sum(
            float(str(r["truth"])) for r in own
        )
    if comparison.measure == "correct":
        return float(np.mean([bool(r["correct"]) for r in own]))
    return float(np.mean([r["distance"] for r in own]))


def figures() -> Iterator[Row]:
    """A row each comparison: 1 where simulated people went the published way."""
    found = []
    for outcome in outcomes(PEOPLE, POOL, None, PROFILE):
        found.append(outcome)
        of = outcome.of
        what = f"{of.measure} of {' and '.join(of.tasks)}"
        name = f"{of.kind}: {what}, {of.level} against {of.baseline}"
        yield row(name, of.source, float(outcome.hit), "of 1")
    for kind in ("prediction", "postdiction"):
        own = [o for o in found if o.of.kind == kind]
        yield row(
            f"{kind}s that went the published way", f"{len(own)}", sum(o.hit for o in own), ""
        )


INTRODUCTION = """# Predictions about others' data

Simulated people are a tool for planning, never evidence. This page counts how often they go the way
that published comparisons went, over every comparison that was read and that this platform can
build. *Derived*: nothing in the model says what a technique is good for, only what its pixels show
decides. *Postdiction*: the result was known when the model was written. `none`: published, no
difference was shown; simulated, the 95 % interval holds 0. Times are differences of logarithms.
"""


def page(found: Sequence[Outcome], people: int, pool: int, profile: str) -> Iterator[str]:
    """The page, line by line."""
    yield INTRODUCTION
    yield "| source | comparison | basis | kind | published | simulated | same way |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for o in found:
        of = o.of
        what = f"{of.measure} of {' and '.join(of.tasks)}: {of.level} against {of.baseline}"
        said = f"{o.direction} ({o.difference:+.3f} [{o.low:+.3f}, {o.high:+.3f}])"
        cells = of.source, what, of.basis, of.kind, of.published, said, "yes" if o.hit else "no"
        yield f"| {' | '.join(cells)} |"
    yield ""
    for kind in ("prediction", "postdiction"):
        own = [o for o in found if o.of.kind == kind]
        hits = sum(o.hit for o in own)
        low, high = share_interval(hits, len(own))
        assert is_defined(low) and is_defined(high)  # there are some of both kinds
        yield f"{kind.capitalize()}s: {hits} of {len(own)} the published way, 95 % interval"
        yield f"[{low:.2f}, {high:.2f}] (Clopper and Pearson).\n"
    yield "Read, but not built here:\n"
    for what, why in NOT_BUILT.items():
        yield f"- {what}: {why}."
    yield "\nPrinted by\n"
    yield (
        f"    python -m seethrough.benchmarks.sessions.predictions --participants {people} "
        f"--pool {pool} --profile {profile}\n"
    )
    yield f"with simulated people of code {code_sha256()}, seed {SEED}."


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the page, or print it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, help="page to write; printed without")
    parser.add_argument("--tables", type=Path, help="read, and kept with what is drawn")
    parser.add_argument("--participants", type=int, default=PEOPLE)
    parser.add_argument("--pool", type=int, default=POOL, help="scenes a task")
    parser.add_argument("--profile", default=PROFILE, help=f"default: {PROFILE}")
    chosen = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        tables = chosen.tables or Path(folder) / "tables.db"
        found = list(outcomes(chosen.participants, chosen.pool, tables, chosen.profile))
    text = "\n".join(page(found, chosen.participants, chosen.pool, chosen.profile)) + "\n"
    if chosen.out is None:
        print(text)
    else:
        chosen.out.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
