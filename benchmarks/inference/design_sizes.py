"""Size and coverage for designs beyond two levels: three levels, groups of unequal size, a cell
left out, skewed times, ordinal answers. Null studies, ten thousand of each kind."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.random import Generator

from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.contrasts import estimate, trend
from seethrough.analysis.stats.flips import sign_flip
from seethrough.analysis.stats.groups import kruskal_wallis
from seethrough.analysis.stats.ranks import friedman, signed_rank
from seethrough.analysis.stats.split_plot import split_plot
from seethrough.benchmarks.inference.sizes import Found, Studies, below, inside

RUNS = 10_000


def three_within(rng: Generator) -> Found:
    """16 people, three levels, normal and spherical."""
    y = rng.normal(0, 1, (16, 1)) + rng.normal(0, 1, (16, 3))
    effect = repeated_measures(y, ["level"])["level"]
    gap = estimate([y[:, 0] - y[:, 1]], [1.0])
    slope = estimate([y @ trend([80.0, 180.0, 380.0])], [1.0])
    return {
        "F, uncorrected": below(effect.p),
        "F, Greenhouse–Geisser": below(effect.p_gg),
        "F, Huynh–Feldt": below(effect.p_hf),
        "contrast": below(gap.p),
        "interval of a contrast": inside(gap.interval, 0.0),
        "linear trend": below(slope.p),
        "sign flips": below(sign_flip(y[:, 0] - y[:, 1], rng)[0]),
    }


def mixed_groups(sizes: tuple[int, int], spreads: tuple[float, float]) -> Callable[..., Found]:
    """Two groups × three levels; the groups differ in size, and in spread where that is asked."""
    groups = np.repeat([[0], [1]], sizes, axis=0)
    sd = np.repeat(spreads, sizes)[:, None]

    def draw(rng: Generator) -> Found:
        y = sd * (rng.normal(0, 1, (len(groups), 1)) + rng.normal(0, 1, (len(groups), 3)))
        effects = split_plot(y, ["level"], groups, ["group"])
        first, second = y[groups[:, 0] == 0], y[groups[:, 0] == 1]
        apart = estimate([first.mean(axis=1), second.mean(axis=1)], [1.0, -1.0])
        gaps = [g[:, 0] - g[:, 1] for g in (first, second)]
        within = estimate(gaps, [0.5, 0.5])
        both = estimate(gaps, [1.0, -1.0])
        return {
            "groups, pooled F": below(effects["group"].p),
            "levels, Greenhouse–Geisser": below(effects["level"].p_gg),
            "groups × levels, Greenhouse–Geisser": below(effects["group × level"].p_gg),
            "groups, Welch": below(apart.p),
            "interval between groups, Welch": inside(apart.interval, 0.0),
            "contrast of levels, own error": below(within.p),
            "interval of a contrast of levels": inside(within.interval, 0.0),
            "contrast of levels between groups": below(both.p),
        }

    return draw


def cell_left_out(rng: Generator) -> Found:
    """12 people, 3 × 3 less a cell: contrasts over shared cells, the omnibus over 2 × 3."""
    y = rng.normal(0, 1, (12, 1, 1)) + rng.normal(0, 1, (12, 3, 3))
    shared = y[:, 0, :2].mean(axis=1) - y[:, 1, :2].mean(axis=1)
    gap = estimate([shared], [1.0])
    found = repeated_measures(y[:, 1:, :], ["view", "clutter"])
    return {
        "contrast over shared cells": below(gap.p),
        "interval of that contrast": inside(gap.interval, 0.0),
        "largest complete table, Greenhouse–Geisser": below(found["clutter"].p_gg),
        "its interaction, Greenhouse–Geisser": below(found["view × clutter"].p_gg),
    }


def skewed_levels(rng: Generator) -> Found:
    """16 people, three levels of log-normal times with spreads .8, .5, .3 and one mean."""
    spread = np.array([0.8, 0.5, 0.3])
    own = rng.normal(0, 0.3, (16, 1))
    logs = own + spread * rng.normal(0, 1, (16, 3))
    raw = np.exp(logs - spread**2 / 2)
    return {
        "F of logarithms, Greenhouse–Geisser": below(
            repeated_measures(logs, ["level"])["level"].p_gg
        ),
        "F of raw times, Greenhouse–Geisser": below(
            repeated_measures(raw, ["level"])["level"].p_gg
        ),
        "contrast of logarithms": below(estimate([logs[:, 0] - logs[:, 2]], [1.0]).p),
        "contrast of raw times": below(estimate([raw[:, 0] - raw[:, 2]], [1.0]).p),
    }


def ordinal(rng: Generator) -> Found:
    """16 people's answers of five points under three levels, and two groups of 7 and 9."""
    answers = np.clip(np.rint(3 + rng.normal(0, 0.5, (16, 1)) + rng.normal(0, 0.9, (16, 3))), 1, 5)
    ranked = friedman(answers, rng)
    level = answers.mean(axis=1)
    groups = kruskal_wallis([level[:7], level[7:]], rng)
    return {
        "Friedman, exact": below(ranked.exact),
        "Friedman, χ²": below(ranked.p),
        "signed ranks": below(signed_rank(answers[:, 0] - answers[:, 1]).p),
        "Mann–Whitney, exact": below(groups.exact),
        "Kruskal–Wallis, χ²": below(groups.p),
    }


def design_kinds() -> list[Studies]:
    """Every kind, and what of it is known not to hold."""
    level = {"interval of a contrast of levels": 0.95}
    between = {**level, "interval between groups, Welch": 0.95}
    pooled = frozenset({"groups, pooled F", "levels, Greenhouse–Geisser",
                        "groups × levels, Greenhouse–Geisser"})  # fmt: skip
    welch = frozenset({"groups, Welch", "interval between groups, Welch"})
    own = frozenset({"contrast of levels between groups", "contrast of levels, own error",
                     "interval of a contrast of levels"})  # fmt: skip
    return [
        Studies("n = 16, 3 levels", three_within, RUNS, {"interval of a contrast": 0.95}),
        Studies("groups of 12 and 5 × 3 levels", mixed_groups((12, 5), (1.0, 1.0)), RUNS, between),
        # Welch's test is approximate: .05 to .06 in groups of five
        Studies("groups of 12 and 5 × 3 levels, s.d. 1 and 3", mixed_groups((12, 5), (1.0, 3.0)),
                RUNS, between, pooled | welch | own),
        Studies("n = 12, 3 × 3 less a cell", cell_left_out, RUNS,
                {"interval of that contrast": 0.95}),
        Studies("n = 16, 3 levels, log-normal, spreads .8 to .3", skewed_levels, RUNS, {},
                frozenset({"F of raw times, Greenhouse–Geisser", "contrast of raw times"})),
        Studies("n = 16, 3 levels, five points; groups of 7 and 9", ordinal, RUNS, {},
                frozenset({"Friedman, χ²"})),
    ]  # fmt: skip
