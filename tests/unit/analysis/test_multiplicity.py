"""Corrections for several tests against R's p.adjust, and what they leave alone."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.analysis.stats.multiplicity import add_holm, holm, holm_of_defined
from seethrough.analysis.stats.undefined import Undefined

# p.adjust(p, "holm") of R, printed with 17 digits; a product of two doubles is off by one in 2⁵³
R = {
    (0.01, 0.02, 0.02, 0.049, 0.3, 0.9): (
        0.059999999999999998, 0.10000000000000001, 0.10000000000000001, 0.14700000000000002,
        0.59999999999999998, 0.90000000000000002,
    ),
    (0.03, 0.5, 0.0004, 0.03, 0.012): (
        0.089999999999999997, 0.5, 0.002, 0.089999999999999997, 0.048000000000000001,
    ),
    (0.6, 0.7): (1.0, 1.0),
    (0.04,): (0.04,),
    (): (),
}  # fmt: skip
GONE = Undefined("nobody differs")


@pytest.mark.parametrize(("p", "adjusted"), R.items(), ids=lambda x: f"{len(x)} tests")
def test_holm_is_that_of_r(p, adjusted):
    np.testing.assert_allclose(holm(p), adjusted, rtol=2e-16 * 2)


def test_families_along_other_axes_are_adjusted_by_themselves():
    first, second = (0.03, 0.5, 0.0004, 0.03, 0.012), (0.2, 0.01, 0.01, 0.001, 0.3)
    both = holm(np.array([first, second]).T)
    assert both[:, 0].tolist() == holm(first).tolist()
    assert both[:, 1].tolist() == holm(second).tolist()


def test_an_undefined_p_stays_so_and_counts_for_nothing():
    """As an NA does in R: p.adjust(c(.03, NA, .0004, .03, NA), "holm")."""
    found = holm_of_defined([0.03, GONE, 0.0004, 0.03, GONE])
    assert found == [pytest.approx(0.06), GONE, pytest.approx(0.0012), pytest.approx(0.06), GONE]
    assert holm_of_defined([GONE]) == [GONE]


def test_rows_are_adjusted_within_their_family():
    p = [0.01, 0.04, 0.03, 0.02, GONE]
    rows: list[dict[str, object]] = [{"p": 1.0, "p_exact": x} for x in p]
    add_holm(rows, ["a", "a", "b", "", "a"], "p_exact")
    assert [r["p_holm"] for r in rows] == [pytest.approx(0.02), pytest.approx(0.04), 0.03, None,
                                           GONE]  # fmt: skip
