"""What simulating costs against an older commit: turns, and the line that is printed of them."""

import pytest

from seethrough.benchmarks.sessions import since


def test_both_play_in_turns_after_a_small_one_and_the_first_changes():
    asked = []

    def player(name, seconds):
        def play(part, share):
            asked.append((name, part, share))
            return seconds

        return play

    found = list(since.spent([player("old", 4.0), player("new", 1.0)], "data", 2))
    assert found == [(4.0, 1.0), (4.0, 1.0)]  # whoever began, the commit's come first
    small = [("old", "data", 1 / 16), ("new", "data", 1 / 16)]
    assert asked[:2] == small
    names = [(name, share) for name, _, share in asked[2:]]
    assert names == [("new", 1), ("old", 1), ("old", 1), ("new", 1)]


def test_the_ratio_is_of_sums_and_each_turn_is_told():
    """By hand: 3 + 2 of 10 + 2 seconds; medians 6 and 2.5."""
    line = since.report("tables", [(10.0, 3.0), (2.0, 2.0)])
    assert line.split() == "tables 6.0 s, now 2.5 s: 0.417 times (turns: 0.300 1.000)".split()


def test_a_code_that_stops_is_said(tmp_path):
    with since.playing(tmp_path) as play, pytest.raises(RuntimeError, match="has stopped"):
        play("data", 1.0)  # the folder holds no code


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--only", "visual,nosuch"], "--only: nosuch; expected some of visual, tables, data"),
        (["--turns", "0"], "--turns: 0; expected at least 1"),
        (["--share", "1.5"], "--share: 1.5; expected a number above 0, at most 1"),
        ([], "nosuchcommit: "),
    ],
)
def test_what_cannot_be_measured_is_refused_in_a_line(words, said, capsys):
    with pytest.raises(SystemExit) as stopped:
        since.main(["nosuchcommit", *words])
    assert stopped.value.code == 2 and said in capsys.readouterr().err
