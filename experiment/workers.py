"""The same work on one core or several: results in the order of the items, whoever made them.

A worker process that dies is replaced, and what it was working on is done again; a result is
handed over once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing import get_context
from typing import Any, TypeVar

Item = TypeVar("Item")
Result = TypeVar("Result")

MOST_DEATHS = 20  # of workers in a row without a result between them: then something is wrong
AHEAD = 2  # items handed out for each worker, so that none waits


def ordered_map(
    work: Callable[[Item], Result],
    items: Sequence[Item],
    workers: int,
    prepare: Callable[..., None] | None = None,
    arguments: tuple[object, ...] = (),
) -> Iterator[Result]:
    """`work(item)` for each item, in order; `prepare(*arguments)` runs once in each process.

    With one worker everything happens here. Raises RuntimeError when workers keep dying, and
    whatever `work` raises, the first in the order of the items.
    """
    if workers == 1:
        if prepare is not None:
            prepare(*arguments)
        yield from map(work, items)
        return
    done: dict[int, Result | _Raised] = {}
    given = 0
    left = list(range(len(items)))
    deaths = 0
    while left:
        try:
            with _executor(workers, prepare, arguments) as executor:
                for index, result in _run(executor, work, items, left, workers):
                    done[index] = result
                    left.remove(index)
                    deaths = 0
                    while given in done:
                        yield _result(done.pop(given))
                        given += 1
        except BrokenProcessPool:
            deaths += 1
            if deaths > MOST_DEATHS:
                raise RuntimeError(f"{deaths} workers died one after the other") from None


@dataclass(frozen=True)
class _Raised:
    """What `work` raised for an item: raised again when it is the item's turn."""

    error: BaseException


def _result(made: Result | _Raised) -> Result:
    if isinstance(made, _Raised):
        raise made.error
    return made


def _executor(
    workers: int, prepare: Callable[..., None] | None, arguments: tuple[Any, ...]
) -> ProcessPoolExecutor:
    # Spawned, not forked: a forked process would share this one's graphics context.
    return ProcessPoolExecutor(
        workers, mp_context=get_context("spawn"), initializer=prepare, initargs=arguments
    )


def _run(
    executor: ProcessPoolExecutor,
    work: Callable[[Item], Result],
    items: Sequence[Item],
    left: Sequence[int],
    workers: int,
) -> Iterator[tuple[int, Result | _Raised]]:
    """(index, result) as they come; only a few items are handed out at a time."""
    waiting = iter(list(left))
    running: dict[Future[Result], int] = {}
    while True:
        while len(running) < AHEAD * workers and (index := next(waiting, None)) is not None:
            running[executor.submit(work, items[index])] = index
        if not running:
            return
        finished, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in finished:
            index, error = running.pop(future), future.exception()
            if isinstance(error, BrokenProcessPool):
                raise error
            yield index, future.result() if error is None else _Raised(error)
