"""Do the report's tests and intervals hold what they say? Size and coverage by simulation.

Each study here is drawn with the truth known, under the assumptions that its line names, and goes
through the report's own functions. A test's size is the share of studies in which it finds what is
not there, for .05; an interval's coverage the share in which it holds the truth. Streams are fixed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from seethrough.analysis.equivalence import Margin, equivalence, log_equivalence
from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.distributions import negligible_p
from seethrough.analysis.stats.multiplicity import holm_of_defined
from seethrough.analysis.stats.paired import one_sample, paired, ratio_of_means, within_halfwidths
from seethrough.analysis.stats.ranks import (
    friedman,
    post_hoc,
    share_interval,
    sign_test,
    signed_rank,
)
from seethrough.analysis.stats.undefined import Interval, Number, either_in, is_defined
from seethrough.analysis.tradeoff import correlation
from seethrough.benchmarks.rows import Row, row

ALPHA = 0.05
SLACK = 3.5
"""Monte-Carlo standard errors that a size may exceed its level by: of 50 lines, one in a hundred
runs of all would have one farther off by chance."""
Found = Mapping[str, bool | None]
"""Whether each test rejected, each interval held the truth; None: it was not defined."""


@dataclass(frozen=True, slots=True)
class Studies:
    """Studies of one kind. `coverage`: the nominal one of the names that are intervals.

    `off`: names known not to hold; they are shown and have no bound, and the report says so
    beside them.
    """

    scene: str
    draw: Callable[[Generator], Found]
    runs: int
    coverage: Mapping[str, float]
    off: frozenset[str] = frozenset()


def sizes(part: float = 1.0) -> Iterator[Row]:
    """All lines, worst first: by how many standard errors a line is on the wrong side.

    `part`: of the runs, for a quick look.
    """
    rows = []
    for number, studies in enumerate(kinds()):
        rng = np.random.default_rng(np.random.SeedSequence(2024, spawn_key=(number,)))
        rows += _measure(studies, max(20, int(studies.runs * part)), rng)
    for _, found in sorted(rows, key=lambda pair: -pair[0]):
        yield found


def _measure(studies: Studies, runs: int, rng: Generator) -> list[tuple[float, Row]]:
    hits: dict[str, list[int]] = {}
    for _ in range(runs):
        for name, hit in studies.draw(rng).items():
            own = hits.setdefault(name, [0, 0])
            own[0] += bool(hit)
            own[1] += hit is not None
    return [_row(studies, name, hit, tried) for name, (hit, tried) in hits.items()]


def _row(studies: Studies, name: str, hit: int, tried: int) -> tuple[float, Row]:
    covers = name in studies.coverage
    nominal = studies.coverage.get(name, ALPHA)
    error = float(np.sqrt(nominal * (1 - nominal) / max(1, tried)))
    share = hit / max(1, tried)
    bad = (nominal - share if covers else share - nominal) / error
    bound = nominal - SLACK * error if covers else nominal + SLACK * error
    figure = f"{'coverage' if covers else 'size'}, {name}"
    unit = f"for {nominal:.2f}, ± {error:.4f}"
    must = None if name in studies.off else float(f"{bound:.4g}")
    return bad, row(figure, studies.scene, share, unit, must, more=covers)


def below(p: Number) -> bool | None:
    """Whether a test rejects."""
    return p < ALPHA if is_defined(p) else None


def inside(ends: Interval, truth: float) -> bool | None:
    """Whether an interval holds the truth."""
    low, high = ends
    return low <= truth <= high if is_defined(low) and is_defined(high) else None


def normal_pairs(rng: Generator, n: int, gap: float = 0.0, r: float = 0.5) -> tuple[Array, Array]:
    """n pairs of mean 10 and 10 + gap, s.d. 2, correlation r."""
    z = rng.standard_normal((2, n))
    return 10 + 2 * z[0], 10 + gap + 2 * (r * z[0] + np.sqrt(1 - r * r) * z[1])


def no_difference(n: int) -> Callable[[Generator], Found]:
    """Tests of two levels that do not differ."""

    def draw(rng: Generator) -> Found:
        a, b = normal_pairs(rng, n)
        test, ranked = paired(a, b), friedman(np.stack([a, b], axis=1), rng)
        return {
            "F and t": below(test.p),
            "interval of the difference": inside(test.interval, 0.0),
            "Shapiro–Wilk": below(test.shapiro_p),
            "Friedman χ², two levels": below(ranked.p),
            "exact sign test": below(ranked.exact),
            "signed ranks": below(signed_rank(a - b).p),
        }

    return draw


def some_difference(rng: Generator) -> Found:
    """Intervals around an effect of d_z = .8."""
    gap = -1.6
    a, b = normal_pairs(rng, 16, gap)
    test = paired(a, b)
    effect = repeated_measures(np.stack([a, b], axis=1), ["c"])["c"]
    half = within_halfwidths(np.stack([a, b], axis=1))[0]
    assert is_defined(half)
    power = 16 * 0.8**2  # the noncentrality
    return {
        "interval of the difference": inside(test.interval, -gap),
        "interval of d_z": inside(test.dz_interval, 0.8),
        "interval of η²p, one df": inside(effect.pes_interval, power / (power + 15)),
        "within-participant interval × √2": bool(
            abs(test.difference + gap) <= float(np.sqrt(2)) * half
        ),
        "interval of the ratio (Fieller)": inside(ratio_of_means(a, b)[1], (10 + gap) / 10),
    }


def at_the_margin(rng: Generator) -> Found:
    """The true difference, or ratio, lies on the margin: nothing may be called equal."""
    own, share = Margin(1.5), Margin(1.2, ratio=True)
    a, b = normal_pairs(rng, 16, 1.5)
    absolute = equivalence(a, b, own)
    a, b = normal_pairs(rng, 16, 2.0)
    ratio = equivalence(a, b, share)
    a, b = normal_pairs(rng, 16)
    logs = log_equivalence(a / 10, b / 10 + float(np.log(1.2)), share)
    found = {}
    for name, tests in (("difference", absolute), ("ratio", ratio), ("log ratio", logs)):
        found[f"TOST, {name}"] = below(either_in(tests, "tost_p"))
        found[f"no worse, {name}"] = below(either_in(tests, "noninferior_p"))
    ends = (either_in(ratio, "low90"), either_in(ratio, "high90"))
    return {**found, "90 % interval of the ratio": inside(ends, 1.2)}


def shares_at_the_margin(share: float) -> Callable[[Generator], Found]:
    """Shares of three trials a person, lower by the margin under dynamic."""

    def draw(rng: Generator) -> Found:
        a = rng.binomial(3, share, 16) / 3
        b = rng.binomial(3, share - 0.10, 16) / 3
        test = equivalence(a, b, Margin(0.10, more=True))
        return {
            "no worse, shares right": below(either_in(test, "noninferior_p")),
            "TOST, shares right": below(either_in(test, "tost_p")),
        }

    return draw


def every_measure(worse: int) -> Callable[[Generator], Found]:
    """Four correlated measures of accuracy, `worse` of which are worse by just their margin: that
    the technique is no worse in every one of them, as P2 asks, the largest p deciding."""

    def draw(rng: Generator) -> Found:
        common = rng.standard_normal((2, 16))
        tests = []
        for k in range(4):
            a, b = (c + rng.standard_normal(16) for c in common)
            tests.append(equivalence(a, b + (k < worse), Margin(1.0)))
        p = [either_in(test, "noninferior_p") for test in tests]
        known = [x for x in p if is_defined(x)]
        return {"no worse in every measure (P2)": below(max(known)) if known == p else None}

    return draw


def four_levels(spread: Array, eta: float = 0.0) -> Callable[[Generator], Found]:
    """16 people under four levels with these s.d. (independent); no effect, or η²p = `eta`."""

    def draw(rng: Generator) -> Found:
        y = rng.standard_normal((16, 4)) * spread + rng.standard_normal((16, 1))
        power = 45 * eta / (1 - eta)
        y = y + np.sqrt(power / 16) * np.array([0.5, 0.5, -0.5, -0.5])
        effect = repeated_measures(y, ["c"])["c"]
        assert is_defined(effect.f)
        if eta:
            return {
                "p of a negligible effect": bool(
                    negligible_p(effect.f, effect.df1, effect.df2, eta) < ALPHA
                ),
                "interval of η²p, three df": inside(effect.pes_interval, eta),
            }
        found = {
            "omnibus F, uncorrected": below(effect.p),
            "omnibus F, Greenhouse–Geisser": below(effect.p_gg),
        }
        # where the s.d. differ, Mauchly's test is right to find it
        return {**found, **({"Mauchly": below(effect.mauchly_p)} if np.ptp(spread) == 0 else {})}

    return draw


def four_ranked(rng: Generator) -> Found:
    """Ratings 0–4 under four levels, tied, without an effect: Friedman and its pairs."""
    y = np.clip(np.rint(rng.normal(2, 1, (12, 4)) + rng.normal(0, 0.5, (12, 1))), 0, 4)
    test, pairs = friedman(y, rng), post_hoc(y)
    return {
        "Friedman χ², four levels": below(test.p),
        "Friedman permutation p, four levels": below(test.exact),
        "any pair, Nemenyi": any(p.nemenyi_p < ALPHA for p in pairs),
        "any pair, signed ranks with Holm": any(below(p.holm_p) for p in pairs),
    }


def four_tasks(rng: Generator) -> Found:
    """Holm over four correlated tasks, none of which differs."""
    common = rng.standard_normal((16, 1))
    gaps = 0.5 * common + rng.standard_normal((16, 4))
    tests = [one_sample(g).p for g in gaps.T]
    return {"any task, Holm": min(p for p in holm_of_defined(tests) if is_defined(p)) < ALPHA}


def shares(rng: Generator) -> Found:
    """Preference of 16: 90 % in truth, and none."""
    hits, even = int(rng.binomial(16, 0.9)), int(rng.binomial(16, 0.5))
    return {
        "interval of a share (Clopper–Pearson)": inside(share_interval(hits, 16), 0.9),
        "sign test of a preference": sign_test(even, 16 - even) < ALPHA,
    }


def correlations(rng: Generator) -> Found:
    """Changes of 16 people: uncorrelated, and with ρ = .6."""
    x, e = rng.standard_normal((2, 16))
    return {
        "p of r": below(correlation(x, e).p),
        "interval of r (Fisher)": inside(correlation(x, 0.6 * x + 0.8 * e).interval, 0.6),
    }


def skewed(n: int) -> Callable[[Generator], Found]:
    """Raw times: log-normal, equal means, the technique's spread of logs .3 instead of .8."""

    def draw(rng: Generator) -> Found:
        z = rng.standard_normal((2, n))
        a = np.exp(0.8 * z[0] - 0.32)
        b = np.exp(0.3 * (0.5 * z[0] + np.sqrt(0.75) * z[1]) - 0.045)
        test = paired(a, b)
        return {"F of raw times": below(test.p),
                "interval of the difference, raw times": inside(test.interval, 0.0),
                "interval of the ratio, raw times (Fieller)": inside(
                    ratio_of_means(a, b)[1], 1.0)}  # fmt: skip

    return draw


def kinds() -> list[Studies]:
    """Every kind of study, and what of it is known not to hold."""
    from seethrough.benchmarks.inference.design_sizes import design_kinds
    from seethrough.benchmarks.inference.printed_sizes import printed_kinds
    from seethrough.benchmarks.inference.session_sizes import mixed_sessions, sessions

    half = {"interval of the difference": 0.95}
    raw = ("F of raw times", "interval of the difference, raw times",
           "interval of the ratio, raw times (Fieller)")  # fmt: skip
    chi = frozenset({"Friedman χ², two levels"})
    even, odd = np.ones(4), np.array([0.5, 1.0, 2.0, 4.0])
    return [
        *(Studies(f"normal, n = {n}", no_difference(n), 4000, half, chi) for n in (3, 8, 16)),
        Studies("normal, n = 16, d_z = .8", some_difference, 4000, {
            **half, "interval of d_z": 0.95, "interval of η²p, one df": 0.90,
            "within-participant interval × √2": 0.95, "interval of the ratio (Fieller)": 0.95,
        }),
        Studies("normal, n = 16, at the margin", at_the_margin, 4000,
                {"90 % interval of the ratio": 0.90}),
        *(Studies(f"n = 16 × 3 trials, share {share:.2f}", shares_at_the_margin(share), 4000, {},
                  frozenset({"no worse, shares right", "TOST, shares right"}))
          for share in (0.98, 0.95, 0.85)),
        Studies("n = 16, 4 levels, spherical", four_levels(even), 6000, {}),
        Studies("n = 16, 4 levels, s.d. 1 to 8", four_levels(odd), 6000, {},
                frozenset({"omnibus F, uncorrected"})),
        Studies("n = 16, 4 levels, η²p = .06", four_levels(even, 0.06), 3000,
                {"interval of η²p, three df": 0.90}),
        Studies("n = 12, 4 levels, tied ratings", four_ranked, 1500, {}),
        Studies("n = 16, 4 tasks", four_tasks, 3000, {}),
        Studies("n = 16, shares", shares, 6000, {"interval of a share (Clopper–Pearson)": 0.95}),
        Studies("n = 16, correlations", correlations, 6000, {"interval of r (Fisher)": 0.95}),
        *(Studies(f"log-normal, n = {n}, spreads .8 and .3", skewed(n), 3000,
                  dict.fromkeys(raw[1:], 0.95), frozenset(raw)) for n in (8, 16, 48)),
        Studies("n = 16, sessions, log-normal", sessions, 1000,
                {"interval of learning": 0.95, "interval of a log ratio": 0.95},
                frozenset({"carry-over"})),
        Studies("n = 12, 2 tasks × 2 trials, log-normal", mixed_sessions, 300,
                {"interval, mixed model": 0.95}),
        *design_kinds(),
        *(Studies(f"n = 16, 4 measures, {k} at the margin", every_measure(k), 3000, {})
          for k in (1, 4)),
        *printed_kinds(),
    ]  # fmt: skip
