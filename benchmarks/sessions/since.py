"""What simulating a study costs, against an older commit, both in turns on the same machine.

`python -m seethrough.benchmarks.sessions.since COMMIT [--turns N] [--only visual,tables,data]`, in
a clone with that commit. Each code plays in a process of its own, with the packages of this one:
the published study, the same people of the profile `average` by number. Measured is processor time
of all threads, the rasteriser's included, so that what else the machine does matters little. For
each part it prints both medians over the turns, the ratio of their sums, this code's over the
commit's, and the ratio in each turn. What is compiled and uploaded once is left out: a smaller turn
comes first.

A process that plays is this file run as a script, `since.py --play FOLDER`: it imports nothing of
the package that it lies in, but the one in FOLDER.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, redirect_stdout
from pathlib import Path
from runpy import run_path
from typing import Any

import numpy as np

# Where modules lie, and where they lay before, the latest place first.
SIMULATE = ("experiment.commands.sessions.simulate", "experiment.commands.simulate")
CONFIG = ("experiment.study.config", "experiment.config")
BATCH = ("experiment.people.runs.batch", "experiment.participants.batch")
DATA_RUN = ("experiment.people.runs.data_run", "experiment.participants.data_run")
STUDY, SEED = "published", 1
PEOPLE = 16
POOL, WALKERS = 50, 32  # a quarter of what `bench simulate` makes tables of
MANY = 32  # people of data mode
PARTS = ("visual", "tables", "data")


class Player:
    """What one folder's code does of each part; every call plays it anew."""

    def __init__(self, get: Callable[[Sequence[str], str], Any], folder: Path) -> None:
        self._get, self._folder, self._made, self._ready = get, folder, 0, False

    def visual(self, share: float) -> None:
        """The real session, drawn and looked at."""
        study = self._get(CONFIG, "load")(STUDY)
        self._get(SIMULATE, "simulate")(study, round(PEOPLE * share) or 1, SEED, self._new())

    def tables(self, share: float) -> None:
        """Tables of the abstract worlds of a pool, and of the buildings as people walk there."""
        job = self._job(round(POOL * share) or 1)
        self._get(DATA_RUN, "make_tables")(job, round(WALKERS * share) or 1)

    def data(self, share: float) -> None:
        """Playing from tables that are there: the first time, of all people, draws them."""
        if not self._ready:
            self._get(BATCH, "prepare")(self._job(POOL))
            self._ready = True
        for first in range(1, MANY + 1, PEOPLE):
            self._get(BATCH, "play_files")(tuple(range(first, first + PEOPLE)))

    def _job(self, pool: int) -> object:
        return self._get(BATCH, "Batch")(STUDY, SEED, pool, self._new())

    def _new(self) -> Path:
        self._made += 1
        return self._folder / str(self._made)


def play(folder: Path) -> None:
    """For each line "PART SHARE" that is read, play it and print the processor seconds it took."""
    # Its file imports nothing of the package either.
    tree = run_path(str(Path(__file__).parents[1] / "drawing" / "against.py"))["Tree"](folder)
    answers = sys.stdout
    with tempfile.TemporaryDirectory() as place, redirect_stdout(sys.stderr):
        player = Player(tree.get, Path(place))
        for line in sys.stdin:
            part, share = line.split()
            start = time.process_time()
            getattr(player, part)(float(share))
            print(time.process_time() - start, file=answers, flush=True)


@contextmanager
def playing(folder: Path) -> Iterator[Callable[[str, float], float]]:
    """A process that plays with a folder's code: (part, share of it) → processor seconds."""
    command = [sys.executable, __file__, "--play", str(folder)]
    pipe, none = subprocess.PIPE, subprocess.DEVNULL
    with subprocess.Popen(
        command, stdin=pipe, stdout=pipe, stderr=none, text=True, cwd=folder
    ) as process:
        assert process.stdin is not None and process.stdout is not None  # pipes
        ask, answer = process.stdin, process.stdout

        def seconds(part: str, share: float) -> float:
            ask.write(f"{part} {share}\n")
            ask.flush()
            if not (line := answer.readline()):
                raise RuntimeError(f"{folder}: what plays has stopped")
            return float(line)

        yield seconds
        ask.close()


def spent(
    players: Sequence[Callable[[str, float], float]], part: str, turns: int, share: float = 1.0
) -> Iterator[tuple[float, ...]]:
    """Seconds of each player in each turn, as they come; which one begins changes with the turn."""
    for play_part in players:
        play_part(part, 1 / PEOPLE)  # compiles and uploads
    for turn in range(turns):
        order = range(len(players)) if turn % 2 else reversed(range(len(players)))
        took = {which: players[which](part, share) for which in order}
        found = tuple(took[which] for which in range(len(players)))
        told = ", ".join(f"{seconds:.1f} s" for seconds in found)
        print(f"since: {part}, turn {turn + 1}: {told}", file=sys.stderr, flush=True)
        yield found


def report(part: str, seconds: Sequence[Sequence[float]]) -> str:
    """A line: (turns, 2) seconds of the commit's code and of this one."""
    old, new = np.array(seconds).T
    turns = " ".join(f"{n / o:.3f}" for o, n in zip(old, new, strict=True))
    ratio = new.sum() / old.sum()
    middle = f"{np.median(old):.1f} s, now {np.median(new):.1f} s"
    return f"{part:8s} {middle}: {ratio:.3f} times (turns: {turns})"


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    if given[:1] == ["--play"]:
        play(Path(given[1]))
        return 0
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commit")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--only", default=",".join(PARTS))
    parser.add_argument("--share", type=float, default=1.0, help="of people and scenes; default: 1")
    args = parser.parse_args(given)
    parts = args.only.split(",")
    if unknown := [part for part in parts if part not in PARTS]:
        parser.error(f"--only: {', '.join(unknown)}; expected some of {', '.join(PARTS)}")
    if args.turns < 1:
        parser.error(f"--turns: {args.turns}; expected at least 1")
    if not 0 < args.share <= 1:
        parser.error(f"--share: {args.share}; expected a number above 0, at most 1")
    from seethrough.benchmarks.older import both_trees  # not where this file runs as a script

    with both_trees(parser, args.commit) as trees, ExitStack() as stack:
        both = [stack.enter_context(playing(tree)) for tree in trees]
        for part in parts:
            print(report(part, list(spent(both, part, args.turns, args.share))), flush=True)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
