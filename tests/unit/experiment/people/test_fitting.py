"""A fit goes where all rows are met, begins where it is told, and stays within its intervals."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published_trials import published_rows

from seethrough.experiment.errors import InputError
from seethrough.experiment.people.fitted import fitting
from seethrough.experiment.people.fitted.calibration import lines, measured, misfit
from seethrough.experiment.people.fitted.fitting import (
    LAST,
    STEEP,
    STEP,
    calibrate,
    slopes_of,
    steep,
    steep_slopes,
)
from seethrough.experiment.people.fitted.priors import FREE, begun, moved, with_free
from seethrough.tasks.kit.skills.profile import AVERAGE


def test_free_constants_stay_within_their_bounds():
    assert with_free(AVERAGE, np.zeros(len(FREE))) == AVERAGE
    far = with_free(AVERAGE, np.full(len(FREE), 9.0))
    assert_allclose(far.pace, AVERAGE.pace * FREE["pace"])
    assert far.diligence <= 1


def test_a_known_pace_is_found_again():
    """A world in which times are exactly proportional to pace, and published at 1.7."""

    def play(profile):
        return [
            {**row, "time": row["time"] * profile.pace / (1.7 * AVERAGE.pace)}
            for row in published_rows(errors=False)
        ]

    said = []
    best, value = calibrate(AVERAGE, play, 60, said.append)
    assert_allclose(best.pace, 1.7, rtol=0.02)
    assert value < misfit(measured(play(AVERAGE))) / 100
    assert len(said) <= 61
    assert all(b <= a for a, b in pairwise(said))


def test_a_larger_crowd_corrects_what_was_peculiar_to_the_first():
    """The first crowd needs 1.7 of the pace, the larger one 1.5: it has the last word."""

    def crowd(needed):
        return lambda profile: [
            {**row, "time": row["time"] * profile.pace / (needed * AVERAGE.pace)}
            for row in published_rows(errors=False)
        ]

    played = []

    def larger(profile):
        played.append(profile)
        return crowd(1.5)(profile)

    best, value = calibrate(AVERAGE, crowd(1.7), 60, last=larger)
    assert_allclose(best.pace, 1.5, rtol=0.02)
    assert value == misfit(measured(crowd(1.5)(best))) and 1 < len(played) <= LAST


def test_derivatives_are_taken_again_as_long_as_there_are_evaluations():
    """Each time every constant alone is moved by a step from the best place so far."""
    played = []

    def play(profile):
        played.append(np.log([getattr(profile, name) for name in FREE]))
        return [
            {**row, "time": row["time"] * profile.pace**2 / 1.7}
            for row in published_rows(errors=False)
        ]

    calibrate(AVERAGE, play, 60)
    stepped = dict.fromkeys(FREE, 0)
    for one in played:
        for place in played:
            way = one - place
            moved = np.abs(way) > 1e-12
            if moved.sum() == 1 and np.isclose(way.max(), STEP):
                stepped[list(FREE)[int(way.argmax())]] += 1
    assert min(stepped.values()) >= 2 and len(played) <= 61


def test_a_fit_begins_where_it_is_told_and_finds_the_minimum_there():
    """Times are right at half of the pace and at twice of it: a fit goes to the nearer of the two.
    How far constants may lie still counts from the profile."""

    def play(profile):
        off = abs(np.log(profile.pace / AVERAGE.pace)) - np.log(2)
        return [{**row, "time": row["time"] * np.exp(off)} for row in published_rows(errors=False)]

    for pace in (0.6, 1.7):
        begin, played = begun(AVERAGE, f"pace={pace},worth=30"), []
        best, _ = calibrate(AVERAGE, lambda p: played.append(p) or play(p), 20, at=begin)  # noqa: B023
        assert played[0] == begin and played[0].worth == 30
        assert_allclose(best.pace, 0.5 if pace < 1 else 2.0, rtol=0.06)
        assert 30 < best.worth  # nothing that was played depends on it: it goes back


def test_a_fit_does_not_leave_one_row_far_off_for_many_near_ones(monkeypatch):
    """T1 takes half as long again as it should beside T4, whatever the pace: with squares alone a
    row stays farther off than it has to."""

    def play(profile):
        tempo = profile.pace / AVERAGE.pace
        return [
            {**row, "time": row["time"] * tempo * (1.5 if row["task"] == "count" else 1.0)}
            for row in published_rows(errors=False)
        ]

    def worst():
        best, _ = calibrate(AVERAGE, play, 34)
        return max(abs(line.off) for line in lines(measured(play(best))) if line.fitted)

    steeply = worst()
    monkeypatch.setattr(fitting, "steep", lambda here: here)
    monkeypatch.setattr(fitting, "steep_slopes", lambda here, slopes: slopes)
    assert steeply < worst() - 0.1


@pytest.mark.parametrize("at", ["worth=14", "worth", "pace=fast", "subitise=0.05", "pace=nan"])
def test_a_fit_begins_with_free_constants_within_their_intervals(at):
    assert begun(AVERAGE, "") == AVERAGE
    assert_allclose(moved(AVERAGE, begun(AVERAGE, "worth=15,slip=0.04")).max(), np.log(4))
    with pytest.raises(InputError, match=rf"--at {at}: expected NAME=VALUE with one of pace 0.33"):
        begun(AVERAGE, f"recheck=0.5,{at}")


def test_a_row_counts_the_more_the_nearer_it_comes_to_the_end_of_what_is_met():
    """By hand: nearly its square at a half, twice at 1.5, (1 + 256 / 81) times at 2; constants as
    they are."""
    off = np.array([0.5, STEEP, -2.0, *[1.25] * len(FREE)])
    found = steep(off) ** 2 / off**2
    assert_allclose(found, [1 + 1 / 81, 2, 1 + 256 / 81, *[1] * len(FREE)], rtol=1e-12)
    assert np.array_equal(np.sign(steep(off)), np.sign(off))
    slopes = np.random.default_rng(2).normal(size=(len(off), 2))
    way = 1e-6 * np.array([1.0, -0.5])
    apart = (steep(off + slopes @ way) - steep(off - slopes @ way)) / 2
    assert_allclose(steep_slopes(off, slopes) @ way, apart, rtol=1e-6)


def test_slopes_of_what_is_linear_are_its_matrix():
    matrix = np.random.default_rng(1).integers(-9, 9, (5, 3))
    assert_allclose(slopes_of(lambda x: matrix @ x + 2, np.array([0.1, 0.0, -0.3])), matrix)
