"""Work on several processes: in order, the same numbers, and a worker that dies is replaced."""

import os
import signal
import time

import pytest

from seethrough.experiment.workers import ordered_map

_prepared: list[str] = []


def prepare(word):
    _prepared.append(word)


def square(x):
    return (_prepared[-1], x * x)


def slow_first(x):
    time.sleep(0.3 if x == 0 else 0.0)
    return x


def die_once(task):
    """Kills its own process the first time item 3 comes up, leaving a mark that it did."""
    mark, x = task
    if x == 3 and not mark.exists():
        mark.write_text("died")
        os.kill(os.getpid(), signal.SIGKILL)
    return x


def die_always(x):
    os.kill(os.getpid(), signal.SIGKILL)


def refuse(x):
    raise ValueError(f"x = {x}, expected better")


@pytest.mark.parametrize("workers", [1, 2])
def test_any_number_of_workers_gives_the_same_in_order(workers):
    assert list(ordered_map(square, range(7), workers, prepare, ("hi",))) == [
        ("hi", x * x) for x in range(7)
    ]
    assert list(ordered_map(square, [], workers, prepare, ("hi",))) == []


def test_results_wait_for_those_before_them():
    assert list(ordered_map(slow_first, range(6), 3)) == list(range(6))


def test_a_worker_that_dies_is_replaced_and_nothing_is_lost_or_twice(tmp_path):
    mark = tmp_path / "mark"
    assert list(ordered_map(die_once, [(mark, x) for x in range(9)], 2)) == list(range(9))
    assert mark.exists()


def test_workers_that_keep_dying_are_given_up(monkeypatch):
    monkeypatch.setattr("seethrough.experiment.workers.MOST_DEATHS", 1)
    with pytest.raises(RuntimeError, match=r"2 workers died one after the other"):
        list(ordered_map(die_always, range(2), 2))


@pytest.mark.parametrize("workers", [1, 2])
def test_what_the_work_raises_arrives(workers):
    with pytest.raises(ValueError, match=r"x = 0, expected better"):
        list(ordered_map(refuse, range(3), workers))
