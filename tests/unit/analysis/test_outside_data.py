"""Data of others, whose licence lets them lie here: five views of things that hide each other.

tests/data/statistics/occluded.R says whose they are (CC BY 4.0) and made the numbers once, by afex,
exactRankTests, psych and factanal in R 4.2.2. Sets under the GPL (obk.long, ANT, Orthodont,
ergoStool) are kept out: data of our own, from seeds, hold the same designs to afex
(split_plot.R, tests/oracles/).
"""

from __future__ import annotations

import numpy as np
import oracles
import pytest

from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.ranks import friedman, post_hoc
from seethrough.analysis.stats.reliability import reliability

VIEWS = ("none", "static", "dynamic", "cloned", "see-through")
OBJECTS = ("button", "dial", "hdmi", "hook", "slider")
R = {row["what"]: float(row["value"]) for row in oracles.rows("occluded_numbers")}


@pytest.fixture(scope="module")
def ratings() -> np.ndarray:
    """(24 people, 5 views, 5 objects)."""
    y = np.full((24, 5, 5), np.nan)
    for row in oracles.rows("occluded"):
        at = int(row["user"]) - 1, VIEWS.index(row["view"]), OBJECTS.index(row["object"])
        y[at] = float(row["rating"])
    assert np.isfinite(y).all()
    return y


def test_the_anova_of_views_and_objects_is_afexs(ratings: np.ndarray) -> None:
    effects = repeated_measures(ratings, ["view", "object"])
    for name in ("view", "object", "view:object"):
        found = effects[name.replace(":", " × ")]
        got = found.f, found.ges, found.eps
        assert got == pytest.approx([R[f"{k} {name}"] for k in ("F", "ges", "eps")], rel=1e-9)


def test_friedman_and_every_pair_are_rs(ratings: np.ndarray) -> None:
    """Means of five whole numbers tie as fractions."""
    y = ratings.mean(axis=2)
    test = friedman(y, np.random.default_rng(1))
    assert (test.chi2, test.p) == pytest.approx((R["friedman chi2"], R["friedman p"]), rel=1e-9)
    pairs = post_hoc(y)
    assert len(pairs) == 10
    for pair in pairs:
        name = f"{VIEWS[pair.first]} - {VIEWS[pair.second]}"
        assert pair.signed.v == R[f"V {name}"]
        assert pair.signed.p == pytest.approx(R[f"p {name}"], rel=1e-9)


def test_alpha_and_omega_of_the_objects_are_rs(ratings: np.ndarray) -> None:
    found = reliability(ratings[:, 0])
    wanted = R["alpha of objects"], R["alpha low"], R["alpha high"]
    assert (found.alpha, *found.interval) == pytest.approx(wanted, rel=1e-9)
    # two optimisers of one flat likelihood
    assert found.omega == pytest.approx(R["omega of objects"], abs=1e-6)
