"""Which frames of a walk are shown in a window."""

from seethrough.benchmarks.sessions.window_frames import RATE, stretches


def test_one_second_of_every_so_many_is_walked_from_the_middle_of_each():
    walk = list(range(50 * RATE))
    shown = stretches(walk, 20)
    # 50 s hold two whole stretches of 20 s, and 10 s that end before a third one's middle.
    assert shown == [*range(9 * RATE + 30, 10 * RATE + 30), *range(29 * RATE + 30, 30 * RATE + 30)]


def test_the_rest_of_a_walk_is_walked_where_its_middle_is_reached():
    assert len(stretches(list(range(55 * RATE)), 20)) == 3 * RATE


def test_of_a_short_walk_its_middle_is_walked():
    assert stretches(list(range(3 * RATE)), 20) == list(range(RATE, 2 * RATE))
    assert stretches(list(range(RATE)), 20) == list(range(RATE))
    assert stretches([], 20) == []
