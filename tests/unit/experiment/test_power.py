"""Power against the closed form, published values and the analysis's own test."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy import stats

from seethrough.analysis.stats.anova import repeated_measures
from seethrough.analysis.stats.ranks import friedman
from seethrough.experiment.people.runs.batch import Batch
from seethrough.experiment.people.runs.batch_files import Results, render
from seethrough.experiment.people.runs.data_mode import Played
from seethrough.experiment.power import power_ranks
from seethrough.experiment.power.power import (
    NormalEffect,
    SampledEffect,
    closed_form,
    curve,
    enough,
    power,
    published,
    rejections,
)
from seethrough.experiment.power.power_data import sampled
from seethrough.experiment.power.power_ranks import RankEffect, trinomial_power
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design import session_for

SHIFT = NormalEffect("shift", (0.5, 0.0), (1.0, 1.0), 0.5)


def test_closed_form_agrees_with_published_values():
    # Superpower's ANOVA_exact, σ = 1, ρ = .5, Δ = .5 in a 2 × 2: main effect, dz = .5/√.5.
    assert_allclose(closed_form(0.5 / 0.5**0.5, 16, 0.05), 0.75298, atol=5e-6)
    # Sample sizes for 80 % that every power table prints: dz .35 → 67, .5 → 34, .8 → 15.
    for dz, n in ((0.35, 67), (0.5, 34), (0.8, 15)):
        assert closed_form(dz, n, 0.05) >= 0.8 > closed_form(dz, n - 1, 0.05)
    assert_allclose(closed_form(0.0, 16, 0.05), 0.05, rtol=1e-9)


def test_drawing_agrees_with_the_closed_form():
    for point in curve([SHIFT, published()[0], published()[-1]], (8, 16, 34), 4000, 0.05, 1):
        error = max((point.exact * (1 - point.exact) / 4000) ** 0.5, 1 / 4000)
        assert abs(point.found - point.exact) < 4 * error
        assert point.low <= point.found <= point.high


def test_rejections_are_those_of_the_analysis():
    rng = np.random.default_rng(3)
    values = SHIFT.draw(rng, 40, 12)
    found = rejections(values, 0.05)
    for replication, expected in zip(values, found, strict=True):
        assert (
            repeated_measures(replication, ("transparency",))["transparency"].p < 0.05
        ) == expected
    assert 0 < found.sum() < 40


def test_draws_have_their_moments():
    values = NormalEffect("x", (10.0, 4.0), (3.0, 1.0), -0.4).draw(
        np.random.default_rng(1), 400, 500
    )
    flat = values.reshape(-1, 2)
    assert_allclose(flat.mean(axis=0), [10, 4], atol=5 * 3 / len(flat) ** 0.5)
    assert_allclose(np.corrcoef(flat.T)[0, 1], -0.4, atol=5 / len(flat) ** 0.5)


def test_the_papers_effects_give_back_its_f():
    for effect, f in zip(
        published(), (49.54, 7.54, 5.28, 22.98, 48.61, 4.74, 4.12, 0.068), strict=True
    ):
        assert_allclose(16 * effect.dz() ** 2, f, rtol=1e-9)
        assert -1 <= effect.r <= 1


def test_enough_is_where_power_stays():
    points = curve(
        [SHIFT, NormalEffect("none", (0.0, 0.0), (1.0, 1.0), 0.0)], range(8, 41, 2), 50, 0.05, 1
    )
    answer = enough(points)
    assert answer["none"] is None
    assert closed_form(SHIFT.dz(), answer["shift"], 0.05) >= 0.8


def test_sampling_keeps_participants_whole_and_says_no_closed_form():
    people = np.array([[1.0, 2.0], [10.0, 20.0], [100.0, 200.0]])
    effect = SampledEffect("doubling", people)
    values = effect.draw(np.random.default_rng(1), 50, 6)
    assert (values[..., 1] == 2 * values[..., 0]).all()
    assert power(effect, 6, 50, 0.05, np.random.default_rng(1)).exact is None


def test_one_seed_one_curve_whatever_else_is_drawn():
    alone = curve([SHIFT], (16,), 200, 0.05, 7)
    among = curve([SHIFT], (8, 12, 16), 200, 0.05, 7)
    assert alone[0] == among[2]


def test_identical_conditions_are_no_effect():
    same = SampledEffect("same", np.array([[1.0, 1.0], [2.0, 2.0]]))
    assert power(same, 8, 100, 0.05, np.random.default_rng(1)).found == 0


@pytest.mark.parametrize(
    "build, message",
    [
        (lambda: NormalEffect("x", (0, 1), (1, 1), 1.5), r"x: r = 1.500, expected a correlation"),
        (lambda: NormalEffect("x", (0, 1), (0, 1), 0.5), r"x: sd = \(0, 1\), expected numbers > 0"),
        (lambda: power(SHIFT, 1, 10, 0.05, np.random.default_rng()), r"participants = 1, expected"),
    ],
)
def test_what_makes_no_sense_is_refused(build, message):
    with pytest.raises(ValueError, match=message):
        build()


def test_what_is_significant_by_ranks_is_significant_to_the_analysis():
    rng = np.random.default_rng(5)
    values = rng.integers(0, 3, (60, 14, 2)) + np.array([0, 0.0])
    values[30:, :, 1] += rng.integers(0, 3, (30, 14))
    found = RankEffect(SampledEffect("x", values[0])).found(values, 0.05)
    expected = []
    for table in values:
        exact = friedman(table, rng).exact
        expected.append(isinstance(exact, float) and exact < 0.05)
    assert found.tolist() == expected and 0 < sum(expected) < 60


def test_rank_tests_agree_with_the_trinomial_and_that_with_scipy():
    people = SampledEffect("x", np.array([[0.0, 1.0]] * 6 + [[1.0, 0.0]] * 2 + [[1.0, 1.0]] * 2))
    normal = RankEffect(NormalEffect("y", (1.0, 0.0), (1.0, 1.0), 0.2))
    for effect in (RankEffect(people), normal):
        for point in curve([effect], (8, 16, 30), 4000, 0.05, 3):
            error = max((point.exact * (1 - point.exact) / 4000) ** 0.5, 1 / 4000)
            assert abs(point.found - point.exact) < 4 * error
    # Without ties: the binomial's own tails. 12 of 14 is significant (p = .013), 11 is not.
    win = normal.chances()[0]
    tails = stats.binom.sf(11, 14, win) + stats.binom.cdf(2, 14, win)
    assert_allclose(trinomial_power(win, 1 - win, 14, 0.05), tails, rtol=1e-9)
    assert trinomial_power(0.0, 0.0, 20, 0.05) == 0


def test_the_papers_rank_tested_people_have_its_moments():
    correct, rating, preferred = power_ranks.published()
    values = correct.people.values
    assert_allclose(values.mean(axis=0), 0.963, atol=6e-4)  # printed to three places
    assert_allclose(values.std(axis=0, ddof=1), (0.109, 0.150), atol=6e-4)
    assert sorted(c * 16 for c in correct.chances()) == [1, 1]  # so that Friedman's p is 1
    assert_allclose(preferred.people.values[:, 1].mean() * 16, 15.5)
    assert rating.exact(16, 0.05) > 0.99  # "Friedman p < .01" with 16


def test_a_folder_gives_every_test_the_analysis_makes(tmp_path):
    study = load("demo")
    rows = []
    rng = np.random.default_rng(1)
    for slot in range(1, 5):
        for task_set in session_for(slot, study.plan):
            for trial in task_set.trials:
                rows.append(_trial(trial, slot, rng))
    about = Batch("demo", 1, 1).about(study)
    with Results(tmp_path, study, about) as results:
        results.add(render(about, study, (1, 2, 3, 4), [Played("demo", "S01", 1, trials=rows)]))
    names = [e.name for e in sampled(tmp_path)]
    assert names == [
        "time, overall", "time count", "time pattern", "time unique", "time count_in_building",
        "relative error count", "relative error count_in_building", "distance unique",
        "right answers pattern (Friedman)",
    ]  # fmt: skip


def _trial(trial, slot, rng):
    answer = {"count": "20", "count_in_building": "6", "pattern": "C", "unique": ""}[trial.task]
    counts = trial.task.startswith("count")
    return {
        "row_id": f"simulated-S{slot:02d}-1-trial{trial.number:03d}", "study": "demo",
        "participant": f"S{slot:02d}", "session": 1, "source": "simulated", "slot": slot,
        "trial": trial.number, "block": trial.block, "task_set": trial.task_set,
        "trial_in_set": trial.in_set, "attempt": 1, **trial.levels,
        "world": trial.world, "task": trial.task, "scene": trial.scene, "targets": 20,
        "time": float(rng.uniform(5, 50)), "time_clean": 5.0, "timed_out": False, "frames": 9,
        "answer": answer, "truth": answer, "correct": bool(rng.random() < 0.7),
        "count_error": 0 if counts else None, "distance": None if trial.task != "unique" else 3.0,
    }  # fmt: skip
