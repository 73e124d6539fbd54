"""Size and coverage of what a report prints besides: means of cells, Cronbach's α, scenes as a
sample, more levels and groups, aligned ranks, predictions of a value."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from seethrough.analysis.mixed import mixed_model
from seethrough.analysis.scenes import scene_model
from seethrough.analysis.stats.aligned import aligned_ranks
from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.arrays import Array
from seethrough.analysis.stats.contrasts import estimate, trend, within_margin
from seethrough.analysis.stats.distributions import t_upper
from seethrough.analysis.stats.groups import kruskal_wallis
from seethrough.analysis.stats.multiplicity import holm_of_defined
from seethrough.analysis.stats.paired import mean_interval, within_halfwidths
from seethrough.analysis.stats.reliability import cronbach
from seethrough.analysis.stats.undefined import is_defined
from seethrough.benchmarks.inference.session_sizes import DESIGN, frame, timed
from seethrough.benchmarks.inference.sizes import ALPHA, Found, Studies, below, inside

MEAN = "interval of a cell's mean"
SHARED = 8
"""Scenes that everybody meets."""


def cell_of_times(n: int, spread: float) -> Callable[[Generator], Found]:
    """The mean of n people's times, of that s.d. of logarithms (0: normal)."""

    def draw(rng: Generator) -> Found:
        z = rng.standard_normal(n)
        values = np.exp(spread * z - spread**2 / 2) if spread else 10 + 2 * z
        return {MEAN: inside(mean_interval(values), 1.0 if spread else 10.0)}

    return draw


def cell_of_shares(n: int, share: float) -> Callable[[Generator], Found]:
    """The mean of n people's shares of three trials. Who all have the same have an interval without
    width."""

    def draw(rng: Generator) -> Found:
        return {MEAN: inside(mean_interval(rng.binomial(3, share, n) / 3), share)}

    return draw


def alpha(k: int, shared: float) -> Callable[[Generator], Found]:
    """16 people's answers to k items that have `shared` of their variance in common."""
    true = k * shared / (1 + (k - 1) * shared)

    def draw(rng: Generator) -> Found:
        common = np.sqrt(shared) * rng.standard_normal((16, 1))
        items = common + np.sqrt(1 - shared) * rng.standard_normal((16, k))
        return {"interval of α (Feldt)": inside(cronbach(items)[1], true)}

    return draw


def four_means(rng: Generator) -> Found:
    """The difference of two of four levels' means within √2 of one's half-width (Cousineau and
    Morey), of 16 people; and four people, too few to estimate ε."""
    y = rng.standard_normal((16, 1)) + rng.standard_normal((16, 4))
    gap = y[:, 0].mean() - y[:, 1].mean()
    half = within_halfwidths(y)[0]
    assert is_defined(half)
    few = repeated_measures(y[:4], ["level"])["level"]
    pairs = [estimate([y[:, a] - y[:, b]], [1.0]).p for a in range(4) for b in range(a)]
    curve = estimate([y @ trend([20.0, 80.0, 180.0, 380.0], 2)], [1.0])
    return {
        "within-participant interval × √2, four levels": bool(abs(gap) <= 2**0.5 * half),
        "omnibus F, lower bound, four people": below(few.p_lower),
        "any pair, t with Holm": any(below(p) for p in holm_of_defined(pairs)),
        "quadratic trend": below(curve.p),
    }


def three_groups(rng: Generator) -> Found:
    """Answers of five points of groups of 5, 6 and 7; two of them apart by just the margin."""
    answers = np.clip(np.rint(rng.normal(3, 1, 18)), 1, 5)
    ranked = kruskal_wallis([answers[:5], answers[5:11], answers[11:]], rng)
    level = rng.standard_normal((2, 9))
    found = estimate([level[0], level[1] + 1.0], [1.0, -1.0])
    worse, _, both = within_margin(found, 1.0)
    return {
        "three groups by ranks, permutations": below(ranked.exact),
        "no worse, between groups": below(worse),
        "TOST, between groups": below(both),
    }


def at_a_value(rng: Generator) -> Found:
    """Scores whose mean is the value that they were to reach: it is not shown to be passed."""
    scores = rng.normal(0.8, 0.1, 16)
    t = estimate([scores - 0.8], [1.0]).t
    return {"at least a value": t_upper(t, 15) < ALPHA if is_defined(t) else None}


def aligned(values: Callable[[Generator], Array]) -> Callable[[Generator], Found]:
    """Aligned ranks of 12 people's 2 × 3 table without any effect."""

    def draw(rng: Generator) -> Found:
        found = aligned_ranks(values(rng), ("view", "clutter"))
        return {"aligned ranks": below(found["clutter"].p)}

    return draw


def normal_table(rng: Generator) -> Array:
    """Normal values, as the ranks' F was made for."""
    return rng.standard_normal((12, 1, 1)) + rng.standard_normal((12, 2, 3))


def five_points(rng: Generator) -> Array:
    """Answers of five points near their end."""
    return np.clip(np.rint(normal_table(rng) * 0.8 + 4.5), 1, 5)


def scene_sessions(rng: Generator) -> Found:
    """16 people, two tasks, eight scenes that all meet: these differ in level and in effect."""
    table = timed(rng, frame(16, 1, SHARED))
    table = table.assign(scene=table["task"].astype(str) + table["trial_in_set"].astype(str))
    code = np.unique(table["scene"], return_inverse=True)[1]
    dynamic = (table["transparency"] == "dynamic").to_numpy(float) - 0.5
    kinds = code.max() + 1
    moved = rng.normal(0, 0.3, kinds)[code] + dynamic * rng.normal(0, 0.2, kinds)[code]
    table = table.assign(time=table["time"] * np.exp(moved))
    fit = mixed_model(table, DESIGN)[0]
    found = scene_model(table, DESIGN, fit).effects
    if not found:
        return {"mixed model with scenes": None, "interval, mixed model with scenes": None}
    return {
        "mixed model with scenes": found[0].p < ALPHA,
        "interval, mixed model with scenes": inside(found[0].interval, 1.0),
    }


def printed_kinds() -> list[Studies]:
    """Every kind, and what of it is known not to hold."""
    mean = {MEAN: 0.95}
    off = frozenset(mean)
    return [
        Studies("normal, n = 8", cell_of_times(8, 0.0), 4000, mean),
        *(Studies(f"times, s.d. .5 of logarithms, n = {n}", cell_of_times(n, 0.5), 4000, mean, off)
          for n in (8, 16)),
        *(Studies(f"n = {n} × 3 trials, share {share:.2f}", cell_of_shares(n, share), 4000, mean,
                  off) for n, share in ((8, 0.95), (16, 0.95), (16, 0.85))),
        *(Studies(f"16 people, {k} items, {shared} in common", alpha(k, shared), 3000,
                  {"interval of α (Feldt)": 0.95}) for k, shared in ((3, 0.5), (6, 0.3))),
        Studies("16 people, four levels", four_means, 3000,
                {"within-participant interval × √2, four levels": 0.95}),
        Studies("groups of 5, 6 and 7; of 9 and 9", three_groups, 1000, {}),
        Studies("16 people at the value", at_a_value, 4000, {}),
        Studies("12 people, 2 × 3, normal", aligned(normal_table), 2000, {},
                frozenset({"aligned ranks"})),
        Studies("12 people, 2 × 3, five points", aligned(five_points), 2000, {},
                frozenset({"aligned ranks"})),
        Studies(f"16 people, 2 tasks × {SHARED} shared scenes", scene_sessions, 150,
                {"interval, mixed model with scenes": 0.95}),
    ]  # fmt: skip
