"""What can be reached, and profile intervals: in made-up worlds whose answers are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published_trials import published_rows

from seethrough.experiment import cli
from seethrough.experiment.people.fitted import search as searching
from seethrough.experiment.people.fitted.calibration import FITTED, published
from seethrough.experiment.people.fitted.priors import (
    FREE,
    SOURCED,
    at,
    intervals,
    moved,
    with_free,
)
from seethrough.experiment.people.fitted.profiled import CHI2, profile_intervals, report
from seethrough.experiment.people.fitted.search import report as reached
from seethrough.experiment.people.fitted.search import search
from seethrough.experiment.people.persons.profile_file import add, made_by, read, write
from seethrough.tasks.kit.skills.profile import AVERAGE

ROWS = sum(len(m.values()) for (task, _), m in published().items() if task in FITTED)


def world(needed, tasks=FITTED):
    """Times proportional to the pace, published at `needed` of the average one; errors that are
    published in T1, and ten times as large in T4, whatever the constants."""

    def play(profile):
        rows = []
        for row in published_rows():
            if row["task"] not in tasks:
                continue
            row = {**row, "time": row["time"] * profile.pace / needed}
            if row["task"] == "count_in_building":
                row["count_error"] = 10 * row["count_error"]
            rows.append(row)
        return rows

    return play


def test_intervals_hold_where_the_search_begins_and_fewer_are_free_than_fitted():
    within = intervals(AVERAGE)
    assert set(within) == {*FREE, *SOURCED} and len(FREE) < ROWS == 20
    for name, own in within.items():
        assert own.low <= getattr(AVERAGE, name) <= own.high, name
    ends = [at(AVERAGE, within, np.full(len(within), u)) for u in (0.0, 1.0, 2.0)]
    for name, own in within.items():
        assert_allclose([getattr(p, name) for p in ends], [own.low, own.high, own.high])
    middle = at(AVERAGE, within, np.full(len(within), 0.5))
    assert_allclose(middle.pace, AVERAGE.pace) and middle.depth_noise == AVERAGE.depth_noise


def test_moves_are_what_with_free_undoes():
    x = np.random.default_rng(3).uniform(-0.6, 0.6, len(FREE))
    assert_allclose(moved(AVERAGE, with_free(AVERAGE, x)), x)


def test_rows_that_no_constant_reaches_are_told_from_those_that_one_does():
    played = []

    def play(profile):
        played.append(profile)
        return world(1.7)(profile)

    found = search(AVERAGE, play, play, 24, np.random.default_rng(1))
    text = {line[:32].strip(): line for line in reached(found, 1.0)}
    assert len(played) >= len(found.u) > 24
    for name, line in text.items():
        if name.startswith("T4 error, mean") or name.startswith("T4 error, s.d."):
            assert f"0 of {len(found.u)}  out of reach" in line
        elif name.startswith("T1 ") or name.startswith("T4 time"):
            assert "within reach" in line
    together = text[next(t for t in text if t.startswith("together"))]
    assert "at most 16 of 20 rows" in together and "T4 error, mean, dynamic" in together
    # Times of every row are met only near the one pace; the best try was led there.
    assert_allclose(found.profile(found.most).pace, 1.7, rtol=0.25)


def test_what_proposals_find_spread_tries_do_not(monkeypatch):
    """A row that a corner of two constants reaches: of 32 spread tries none, of those that are
    proposed for this row alone some."""
    monkeypatch.setattr(searching, "TOGETHER", 0)

    def play(profile):
        rows = world(1.0)(profile)
        off = np.log(profile.sd_person / AVERAGE.sd_person) + np.log(profile.slip / AVERAGE.slip)
        for row in rows:
            if row["task"] == "count" and row["transparency"] == "standard":
                row["time"] *= np.exp(2.6 - off)  # met at e^2.6: sixteen times both is e^2.77
        return rows

    found = search(AVERAGE, play, play, 32, np.random.default_rng(2))
    k = found.names.index("T1 time, mean, standard")
    off = np.abs(found.table[:, k])
    assert off[:32].min() > 2 and off.min() <= 2


def test_what_few_reach_other_people_have_to_reach_as_well():
    """Times are met by the few at some narrow range of paces; others are never near."""

    def few(profile):
        return world(profile.pace if 1.0 < profile.pace < 1.05 else 0.1)(profile)

    found = search(AVERAGE, few, world(0.1), 24, np.random.default_rng(1))
    line = next(x for x in reached(found, 1.0) if x.startswith("T1 time, mean, standard"))
    assert "out of reach: +" in line and "by other people" in line


def linear(seed, rows=20, scale=8.0):
    """Residuals A x + b about their least at `best`, as the fit has them, and A."""
    rng = np.random.default_rng(seed)
    slopes = scale * rng.standard_normal((rows, len(FREE)))
    best = rng.uniform(-0.05, 0.05, len(FREE))
    apart = rng.standard_normal(rows)
    apart -= slopes @ np.linalg.lstsq(slopes, apart, rcond=None)[0]  # nothing left to gain
    return (lambda x: apart + slopes @ (x - best)), slopes, best


def test_intervals_of_what_is_linear_are_least_squares_own():
    """± √(3.84 s² (AᵀA)⁻¹ₖₖ): the textbook's standard errors, where no limit is near."""
    residuals, slopes, best = linear(1, scale=30.0)
    here = residuals(best)
    found = profile_intervals(residuals, slopes, here, best, len(here))
    s2 = here @ here / (len(here) - len(best))
    half = np.sqrt(CHI2 * s2 * np.diag(np.linalg.inv(slopes.T @ slopes)))
    assert (half < np.log(2)).all()
    for own in found:
        k = own.number
        assert_allclose([own.low.x[k], own.high.x[k]], [best[k] - half[k], best[k] + half[k]],
                        atol=3e-4)  # fmt: skip
        # Played, the objective has risen by just what ends an interval.
        assert_allclose([own.low.rise, own.high.rise], 1.0, atol=0.02)
        assert not own.low.limit and not own.high.limit


def test_a_constant_that_nothing_depends_on_ends_at_its_limits():
    residuals, slopes, best = linear(2)
    slopes[:, 3] = 0.0
    here = residuals(best)
    own = profile_intervals(residuals, slopes, here, best, len(here))[3]
    limit = np.log(list(FREE.values())[3])
    assert_allclose([own.low.x[3], own.high.x[3]], [-limit, limit])
    assert own.low.limit and own.high.limit
    line = report(AVERAGE, AVERAGE, [own], 1.0)[1]
    assert line.startswith("diligence") and line.count("(its limit)") == 2


def test_an_end_beyond_which_more_happens_than_slopes_say_is_moved_nearer():
    """Residuals twice as steep as their slopes: squares rise four times as fast, so that ends lie
    half as far away; the rise that was played is an interval's end again."""
    residuals, slopes, best = linear(3, scale=30.0)
    here = residuals(best)

    def steep(x):
        return here + 2 * (residuals(x) - here)

    straight = profile_intervals(residuals, slopes, here, best, len(here))
    for one, own in zip(
        straight, profile_intervals(steep, slopes, here, best, len(here)), strict=True
    ):
        k = one.number
        for end, moved_end in ((one.low, own.low), (one.high, own.high)):
            assert_allclose(moved_end.x[k] - best[k], (end.x[k] - best[k]) / 2, rtol=0.02)
            assert_allclose(moved_end.rise, 1.0, atol=0.05)


def test_tables_are_added_to_what_a_fit_wrote(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    profile = with_free(AVERAGE, np.full(len(FREE), 0.1))
    write(path, profile, {"command": "fit", "table": ["a"]})
    add(path, "search", {"command": "searched", "table": ["b", "c"]})
    add(path, "intervals", {"command": "profiled", "table": ["d"]})
    assert made_by(str(path)) == ("fit", ("a",))
    assert made_by(str(path), "search") == ("searched", ("b", "c"))
    assert made_by(str(path), "intervals") == ("profiled", ("d",))
    assert made_by("average", "search") == ("", ())
    assert_allclose(moved(profile, read(path)), 0, atol=1e-12)
    words = ["calibrate", "demo", "--tables", str(tmp_path / "t.db"), "--part", "search", "--out"]
    assert cli.main([*words, str(tmp_path / "none.toml")]) == 2
    assert "expected a profile that a fit wrote" in capsys.readouterr().err


@pytest.mark.parametrize("name", SOURCED)
def test_every_source_is_named(name):
    assert SOURCED[name].source and 0 < SOURCED[name].low < SOURCED[name].high
