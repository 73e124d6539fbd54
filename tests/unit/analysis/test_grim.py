"""What answers can have a printed mean and s.d., against all answers there are."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations_with_replacement, product

import numpy as np
import pytest

from seethrough.analysis.published.grim import (
    fitting_scores,
    mean_of_shares,
    partitions,
    totals,
)
from seethrough.analysis.published.numbers import Moments, Printed


def moments(mean, sd="9.999"):
    return Moments(Printed(mean), Printed(sd))


def fits(value, text):
    """Within half of the last printed digit, its ends included."""
    places = len(text.partition(".")[2])
    return abs(Fraction(value) - Fraction(text)) <= Fraction(1, 2 * 10**places)


@pytest.mark.parametrize("highest", [1, 3])
@pytest.mark.parametrize("count", [1, 2, 7])
def test_totals_are_those_of_all_answers_and_no_others(count, highest):
    """Every printed mean from below the scale to beyond its end."""
    for hundredths in range(0, 100 * highest + 60):
        text = f"{hundredths / 100:.2f}"
        right = [t for t in range(count * highest + 1) if fits(Fraction(t, count), text)]
        assert totals(moments(text), count, highest) == right


@pytest.mark.parametrize(("n", "trials"), [(2, (3,)), (3, (2, 4)), (1, (1,))])
def test_a_mean_of_shares_is_found_where_some_answers_have_it(n, trials):
    lcm = int(np.lcm.reduce(trials))
    for hundredths in range(160):
        text = f"{hundredths / 100:.2f}"
        right = [k for k in range(n * lcm + 1) if fits(Fraction(k, n * lcm), text)]
        found = mean_of_shares(moments(text), n, trials)
        assert found == (Fraction(right[0], n * lcm) if right else None)
        shares = {Fraction(c, t) for t in trials for c in range(t + 1)}
        possible = {sum(own) / n for own in combinations_with_replacement(sorted(shares), n)}
        if any(fits(value, text) for value in possible):
            assert found is not None


@pytest.mark.parametrize(("total", "parts", "largest"), list(product(range(7), range(4), range(5))))
def test_partitions_are_all_of_them_once(total, parts, largest):
    found = list(partitions(total, parts, largest))
    right = {
        tuple(sorted((v for v in values if v), reverse=True))
        for values in product(range(largest + 1), repeat=parts)
        if sum(values) == total
    }
    assert len(found) == len(set(found)) and set(found) == (right or set())


def test_scores_that_fit_are_those_of_all_people():
    """Four people of three trials each: every answer sheet, its mean and s.d. printed."""
    n, trials = 4, 3
    sheets = list(combinations_with_replacement(range(trials + 1), n))
    for sheet in sheets:
        shares = np.array(sheet) / trials
        printed = moments(f"{shares.mean():.3f}", f"{shares.std(ddof=1):.3f}")
        found = {tuple(e) for e in fitting_scores(printed, n, trials)}
        wrong = tuple(sorted((trials - c for c in sheet if c < trials), reverse=True))
        assert wrong in found
        for errors in found:
            own = np.ones(n)
            own[: len(errors)] -= np.array(errors) / trials
            assert abs(own.mean() - shares.mean()) <= 1.1e-3
            assert abs(own.std(ddof=1) - shares.std(ddof=1)) <= 1.1e-3
