"""`seethrough bench simulate`: parts by name, and the figure of what accuracy costs in time."""

from types import SimpleNamespace

import numpy as np
import pytest

from seethrough.benchmarks.sessions import simulate
from seethrough.experiment import cli
from seethrough.renderer.events import KeyPress, KeyRelease, Tick


@pytest.mark.parametrize(
    "words, message",
    [
        (
            "bench simulate --only speed",
            "--only = speed: expected some of visual, memory, data, many",
        ),
        (
            "bench statistics --only data",
            "--only = data: expected some of sizes, accuracy, reports",
        ),
        ("bench session --only data", "--only = data: expected some of no parts"),
    ],
)
def test_parts_that_are_not_there_are_one_line(capsys, words, message):
    assert cli.main(words.split()) == 2
    told = capsys.readouterr().err
    assert message in told and told.count("\n") == 1


def test_only_the_parts_asked_for_are_measured(monkeypatch, capsys):
    ways = [
        {"scene": f"visual, {k} px", "value": k, "unit": "ms", "time_error": e, "count_error": 0.0}
        for k, e in ((300, 0.0), (150, -0.02))
    ]
    monkeypatch.setattr(simulate.eyes, "run", lambda repeats: ways)
    assert cli.main(["bench", "simulate", "--only", "eyes"]) == 0
    printed = capsys.readouterr()
    assert [line.split("  ")[0] for line in printed.out.splitlines()] == [
        "eyes: visual, 300 px",
        "eyes: visual, 150 px",
    ]
    assert printed.err == "bench simulate: eyes\n"  # what is being measured


def test_the_figure_has_a_point_for_each_way_to_look(tmp_path):
    names = [way.name for way in simulate.eyes.WAYS[1:4]]
    rows = [
        {**simulate.told(f"eyes: {name}", 10.0, "ms"), "time_error": 0.01, "time_error_se": 0.002}
        for name in names
    ]
    path = tmp_path / "eyes.svg"
    simulate.chart([*rows, simulate.told("tables", 2.0, "min")], path)
    text = path.read_text(encoding="utf-8")
    assert all(name in text for name in names) and "tables" not in text


def test_more_is_better_for_a_ratio_and_less_for_a_time():
    assert simulate.figure("a", 1.8, "×", 1.7, 1.9, more=True)["met"]
    assert not simulate.figure("a", 1.6, "×", 1.7, 1.9, more=True)["met"]
    assert simulate.figure("a", 2.9, "s", 3, 1)["met"]
    assert not simulate.figure("a", 3.1, "s", 3, 1)["met"]


def record(seconds, error, world="building", frames=0):
    """As much of a trial as the eyes' rows look at."""
    return SimpleNamespace(time=seconds, frames=frames, trial=SimpleNamespace(world=world),
                           outcome=SimpleNamespace(count_error=error))  # fmt: skip


def test_a_way_to_look_is_told_by_its_pairs_with_the_reference():
    """By hand: times twice and half as long cancel; their logarithms differ by ±ln 2, s.e. ln 2."""
    finest = simulate.eyes.Eyes("finest", 1.0, (record(10, 0), record(40, -2)))
    trials = (record(20, 1, frames=30), record(20, 2, "abstract", 99))
    row = simulate.eyes.measure(simulate.eyes.Eyes("coarse", 0.25, trials), finest)
    assert (row["value"], row["looks_a_second"]) == (250, 1.5)
    assert (row["time_error"], row["time_error_se"]) == (0, pytest.approx(np.log(2), abs=1e-4))
    assert (row["count_error"], row["count_error_se"]) == (0.5, 0.5)


def test_ways_to_look_have_names_of_their_own():
    names = [way.name for way in simulate.eyes.WAYS]
    assert len(set(names)) == len(names) and "visual, 150 px" in names


def test_looks_while_walking_leave_thinking_out():
    """By hand: a step of a second and one of half, three looks; the looks between do not count."""
    first = [KeyPress(5.0, "up"), Tick(5.5), KeyRelease(6.0, "up"), Tick(6.0), Tick(20.0)]
    second = [KeyPress(30.0, "up"), KeyRelease(30.5, "up"), Tick(30.5)]
    assert simulate.eyes.walking([[*first, *second]]) == 2.0
    assert simulate.eyes.walking([[Tick(1.0)], []]) == 0.0


def test_the_figure_tells_ways_to_look_apart():
    """Colour tells looks on the way, the mark rows: no two ways look the same."""
    bench = simulate.eyes
    drawn = [(bench.COLOURS[w.passing], bench.MARKS[w.height], w.simple) for w in bench.WAYS]
    assert len(set(drawn)) == len(drawn)
