"""Calibration against made-up data, and profiles as files."""

import argparse
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from published_trials import published_rows

from seethrough.analysis.published.numbers import load_published
from seethrough.experiment import cli
from seethrough.experiment.commands.data import calibrate as command
from seethrough.experiment.errors import InputError
from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.fitted.calibration import (
    LEVELS,
    SEEN,
    TASKS,
    Moments,
    differences,
    gained,
    lines,
    measured,
    misfit,
    published,
    table,
)
from seethrough.experiment.people.fitted.fitting import Crowd
from seethrough.experiment.people.persons.person import TRAITS, Person, mood_for
from seethrough.experiment.people.persons.profile_file import (
    SHIPPED,
    find,
    made_by,
    provenance_of,
    read,
    write,
)
from seethrough.experiment.people.runs.pool import Pool
from seethrough.experiment.study.config import load
from seethrough.experiment.study.design.design import generator, session_for
from seethrough.tasks.kit.skills.profile import AVERAGE


def test_data_with_the_published_moments_are_met_exactly():
    found = measured(published_rows())
    assert set(found) == set(published())
    for (task, what), theirs in published().items():
        if what == "error":
            continue  # a share's absolute value: see below
        assert_allclose(found[task, what].means, theirs.means, rtol=1e-9)
        assert_allclose(found[task, what].sds, theirs.sds, rtol=1e-9)
        if theirs.r is not None:
            assert_allclose(found[task, what].r, theirs.r, atol=1e-9)
    met = {line.name: line for line in lines(found)}
    assert all(abs(line.off) < 1e-9 for line in met.values() if "error" not in line.name)
    assert all(met[f"T3 time, mean, {lv}"].verdict == "agrees" for lv in LEVELS)


def test_errors_of_counts_add_up_with_their_signs():
    """|Σ error| / Σ truth, by hand: +3, −1, −1 of 10, 20, 30 is 1 / 60."""
    rows = [
        {"task": "count", "transparency": level, "participant": person, "time": 1.0 + person,
         "count_error": error * (1 + person), "truth": truth}
        for level in LEVELS for person in (0, 1)
        for error, truth in ((3, 10), (-1, 20), (-1, 30))
    ]  # fmt: skip
    found = measured(rows)["count", "error"]
    assert_allclose(found.means, [1.5 / 60] * 2, rtol=1e-12)


def test_implied_correlations_are_those_of_the_study_page():
    expected = {"count": 0.867, "pattern": 0.721, "unique": 0.378, "count_in_building": 0.388}
    for task, r in expected.items():
        assert_allclose(published()[task, "time"].r, r, atol=5e-4)  # printed to three places


def test_rows_are_off_by_standard_errors_of_sixteen_people():
    """By hand: a mean one s.e. (s.d. / 4) above, an s.d. one (s.d. / √30), r one in Fisher's z."""
    theirs = published()["count", "time"]
    z = np.tanh(np.arctanh(theirs.r) + 1 / 13**0.5)
    off = Moments(
        (theirs.means[0] + theirs.sds[0] / 4, theirs.means[1]),
        (theirs.sds[0], theirs.sds[1] * (1 + 1 / 30**0.5)),
        float(z),
    )
    found = [line.off for line in lines({("count", "time"): off})]
    assert_allclose(found, [1, 0, 0, 1, 1], atol=1e-9)
    assert_allclose(misfit({("count", "time"): off}), 3 / 5, rtol=1e-9)


def test_a_published_difference_has_the_standard_error_that_its_f_implies():
    """F(1, n − 1) = (difference / s.e.)²: for T1's times 15.82 / √7.54 = 5.76 s."""
    printed = {m.name: m for m in load_published().measures}
    for (task, what), m in published().items():
        if m.r is not None:
            value, error = m.difference()
            f = printed[f"{what}_{TASKS[task]}"].f.value
            assert_allclose(error, abs(value) / f**0.5, rtol=1e-9)
    assert_allclose(published()["count", "time"].difference(), (-15.82, 5.7613), atol=1e-4)


def test_differences_are_off_by_that_and_told_apart_from_rows():
    """By hand: standard a half of a difference's s.e. longer, dynamic one and a half shorter."""
    theirs = published()["count", "time"]
    error = theirs.difference()[1]
    means = (theirs.means[0] + error / 2, theirs.means[1] - 1.75 * error)
    found = {**published(), ("count", "time"): Moments(means, theirs.sds, theirs.r)}
    told = {line.name: line for line in differences(found)}
    assert len(told) == sum(m.r is not None for m in published().values()) == 7
    off = told.pop("T1 time, dynamic − standard")
    assert_allclose(off.off, -2.25, rtol=1e-9)
    assert off.verdict == "not met" and off.fitted
    assert all(abs(line.off) < 1e-9 for line in told.values())
    assert {line.verdict for line in told.values()} == {"met", "agrees"}
    assert not set(told) & {line.name for line in lines(found)}
    text = gained(found, published())
    assert len(text) == 1 + 7 and sum("fitted: met" in line for line in text) == 3


@pytest.mark.parametrize(
    "apart, people, verdict",
    [(0.0, 10_000, "agrees"), (1.0, 10_000, "agrees"), (2.1, 10_000, "cannot tell"),
     (2.3, 10_000, "contradicts"), (0.0, 16, "agrees"), (0.3, 16, "cannot tell"),
     (5.0, 16, "contradicts")],
)  # fmt: skip
def test_what_is_not_fitted_agrees_contradicts_or_leaves_it_open(apart, people, verdict):
    """t(15) is 2.131 at 97.5 %: the published interval is that many standard errors wide."""
    theirs = published()["unique", "time"]
    step = apart * theirs.sds[0] / 4
    ours = Moments((theirs.means[0] + step, theirs.means[1]), theirs.sds, theirs.r, people)
    (first,) = (x for x in lines({("unique", "time"): ours}) if x.name == "T3 time, mean, standard")
    assert first.verdict == verdict


def test_three_people_say_nothing_of_a_correlation():
    few = Moments((1.0, 1.0), (1.0, 1.0), 0.5, 3)
    assert few.errors()["r"] == np.inf and np.isfinite(few.errors()["mean, standard"])


def test_a_crowd_is_spread_evenly_over_what_people_are_like():
    """512 drawn people would have means off by .044 (s.e.), these by less than a third of it."""
    study = load("demo")
    crowds = [Crowd(seed, 512, Pool(study, 1)) for seed in (1, 1, 2)]
    traits = [crowd.traits for crowd in crowds]
    assert np.array_equal(traits[0], traits[1]) and not np.array_equal(traits[0], traits[2])
    for each in traits:
        assert each.shape == (512, TRAITS)
        assert_allclose(each.mean(axis=0), 0, atol=0.03)
        assert_allclose(each.std(axis=0), 1, atol=0.03)
        assert_allclose(np.corrcoef(each.T), np.eye(TRAITS), atol=0.06)


def test_what_people_are_like_has_nothing_to_do_with_which_condition_they_meet_first():
    """A column that alternates as the Latin square does puts all careful people into one order."""
    study = load("published")
    for seed in (1, 11):
        traits = Crowd(seed, 96, Pool(study, 1)).traits
        first: dict[str, list[bool]] = {}
        for slot in range(1, 97):
            levels: dict[str, str] = {}
            for task_set in session_for(slot, study.plan):
                trial = task_set.trials[0]
                levels.setdefault(trial.task, trial.levels["transparency"])
            for task, level in levels.items():
                first.setdefault(task, []).append(level == "dynamic")
        for task, dynamic in first.items():
            assert sum(dynamic) == 48, task
            apart = traits[dynamic].mean(axis=0) - traits[np.invert(dynamic)].mean(axis=0)
            assert np.abs(apart).max() < 0.3, (seed, task)  # care was .9 apart


def test_given_traits_make_the_person_and_leave_the_trials_luck_alone():
    drawn = Person(generator(3, (2, 1)), AVERAGE)
    traits = generator(3, (2, 1)).standard_normal(TRAITS)
    given = Person(generator(3, (2, 1)), AVERAGE, traits=traits)
    other = Person(generator(3, (2, 1)), AVERAGE, traits=np.zeros(TRAITS))
    assert given.pace == drawn.pace and given.care == drawn.care
    assert other.care == AVERAGE.care and set(other.pace.values()) == {AVERAGE.pace}
    moods = [mood_for(person, "count", 0.0) for person in (drawn, other)]
    assert moods[0].rng.random() == moods[1].rng.random()


def test_table_has_every_published_row_with_its_verdict():
    rows = table(measured(published_rows()), measured(published_rows()))
    count = sum(len(m.values()) for m in published().values())
    assert len(rows) == 1 + count == 1 + 4 * 5 + 3 * 5 + 4
    assert sum("  seen: " in row for row in rows) == sum(
        len(m.values()) for (task, _), m in published().items() if task in SEEN
    )
    assert all("fitted: met" in row for row in rows if " time, mean" in row and "T1" in row)


def test_profiles_survive_being_written(tmp_path):
    profile = replace(AVERAGE, name="mine", pace=1.25, tracked=3)
    path = tmp_path / "mine.toml"
    write(path, profile, {"command": 'a "quoted" one', "fitted": ["count"], "misfit": 0.5})
    assert read(path) == profile and find(str(path)) == profile
    assert find("careful").name == "careful"


@pytest.mark.parametrize(
    "text, message",
    [
        (
            "[profile]\npaec = 1.0",
            r"p.toml: profile.paec = 1.0: unknown key, did you mean pace\? known: attention_shift",
        ),
        ("[profile]\npace = 'fast'", r"p.toml: profile.pace = \"fast\": expected a number"),
        ("[profile]\nname = 3", r"p.toml: profile.name = 3: expected a text"),
        ("[profile]\npace = true", r"p.toml: profile.pace = true: expected a number"),
        ("[profile]\nkey = -2", r"p.toml: profile.key = -2, expected a number from 0 to 1000"),
        ("profile = 3", r"p.toml: profile = 3: expected a table"),
        ("[profile", r"p.toml: "),
    ],
)
def test_bad_profile_files_are_refused_in_a_line(tmp_path, text, message):
    path = tmp_path / "p.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read(path)


def test_a_profile_nobody_knows_is_refused():
    with pytest.raises(InputError, match=r"--profile = hero: expected one of average, careful"):
        find("hero")


def test_the_calibrated_profile_ships_with_its_provenance():
    profile = find("calibrated")
    assert profile.name == "calibrated" and profile != AVERAGE
    text = (SHIPPED / "calibrated.toml").read_text(encoding="utf-8")
    assert "never evidence" in text and "seen" in text and "seethrough calibrate" in text


def test_a_check_that_is_interrupted_leaves_the_fitted_profile(tmp_path, monkeypatch):
    """It could be searched and profiled; it says that nobody checked it."""

    def play(crowd, profile, tasks):
        if crowd.seed == 1:  # the other participants
            raise KeyboardInterrupt
        return [{**r, "time": r["time"] * profile.pace / 1.7} for r in published_rows()]

    monkeypatch.setattr(Crowd, "play", play)
    out = tmp_path / "own.toml"
    words = f"calibrate demo --evaluations 2 --tables {tmp_path / 't.db'} --out {out}"
    assert cli.main(words.split()) == 130
    fitted = read(out)
    assert fitted.name == "own"
    assert_allclose(fitted.pace, 1.7, rtol=1e-6)
    said = provenance_of(out)
    assert said["checked"] == "not yet" and "table" not in said and said["last"] == 192
    assert made_by(str(out)) == (said["command"], ())


def test_the_command_that_made_a_profile_can_be_given_again():
    parser = argparse.ArgumentParser()
    command.add_arguments(parser)
    words = (
        "demo --profile hasty --at pace=0.8,worth=70 --participants 5 --evaluations 7 --last 6 "
        "--seed 3 --pool 2 --check 4"
    )
    files = ["--tables", "t.db", "--out", "p.toml"]
    arguments = parser.parse_args([*words.split(), "--check-seed", "9", *files])
    told = command._provenance(arguments, "hasty", 1.0, [])
    program, name, *again = told["command"].split()
    assert (program, name) == ("seethrough", "calibrate")
    assert parser.parse_args([*again, *files]) == arguments
    assert code_sha256() in told["code"] and len(code_sha256()) == 12


@pytest.mark.parametrize("where", ["", "a file/p.toml"])
def test_a_profile_that_cannot_be_written_is_refused_before_anybody_plays(
    tmp_path, capsys, monkeypatch, where
):
    monkeypatch.setattr(Crowd, "play", lambda *_: pytest.fail("played"))
    (tmp_path / "a file").touch()
    out = tmp_path / where
    words = ["calibrate", "demo", "--tables", str(tmp_path / "t.db"), "--out", str(out)]
    assert cli.main(words) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"seethrough: --out = {out}: ")
    refused = ("expected a file's name, not a folder's", "File exists", "Not a directory")
    assert line.endswith(refused)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a file"]
