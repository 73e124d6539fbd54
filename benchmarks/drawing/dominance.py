"""Who sees more finds at least as much, and no later: the first promise of simulated people.

The same people count in the same worlds twice, with the same luck: once every red thing is visible
in some views only, once in all of these and in more, or larger. `python -m
seethrough.benchmarks.drawing.dominance` plays until half-widths are 2 % or less; the tests play
fewer. How times move along visibility is shown, and no direction asked of it: who sees nothing
quits.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from unittest import mock

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.suites.plain_looks import plain_look
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.catalog import TASKS, setting
from seethrough.tasks.count import simulate
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.red import red_things

ASPECT = 4 / 3
LOOKS = 6  # after so many looks recall is compared
PART = 0.8  # of the red things: who has noticed so many is timed
SEEDS = 900


@dataclass(frozen=True)
class Shown:
    """How much a world shows: of each thing's views the part `views`, of its pixels `share`."""

    views: float
    share: float = 1.0


@dataclass(frozen=True)
class Played:
    """One trial: recall after each of `LOOKS` looks, seconds until `PART` was noticed (NaN: never),
    seconds of the whole, |error| as a part of the truth."""

    recall: tuple[float, ...]
    found: float
    seconds: float
    error: float


def play(shown: Shown, seed: int) -> Played:
    """A person counts in a world that shows so much; the luck is the seed's."""
    task = TASKS["count"]
    given = setting(task)
    state = task.begin(task.make_scene(np.random.default_rng(seed), given), given, ASPECT)
    person = SimulatedParticipant(np.random.default_rng([seed, 1]))
    person.begin_trial("count", 0.0)
    hidden = np.random.default_rng([seed, 2])
    seen: set[int] = set()
    noticed: list[tuple[float, int]] = []
    looks: dict[float, Visibility] = {}

    def look(view: View, now: float) -> Visibility:
        if now not in looks:  # a view's luck is drawn once, the same for whoever sees more
            draws = hidden.random(len(view.scene.objects))
            looks[now] = _dimmed(plain_look(view, ASPECT, draws < shown.views), shown.share)
        return looks[now]

    def counted(mood: Mood, glance: Glance) -> NDArray[np.int64]:
        red = red_things(mood, glance)
        seen.update(red.tolist())
        noticed.append((glance.now, len(seen)))
        return red

    now = 0.0
    with mock.patch.object(simulate, "red_things", counted):
        while task.outcome(state) is None:
            view = task.view(state)
            for event in person.events(view, partial(look, view, now), now, "count"):
                state = task.on_event(state, event)
                now = max(now, event.time)
    outcome = task.outcome(state)
    assert outcome is not None and outcome.count_error is not None
    truth = int(outcome.truth)
    counts = [count for _, count in noticed] + [noticed[-1][1]] * LOOKS
    # A look's things are counted by the time of the next one.
    ends = [*(time for time, _ in noticed[1:]), now]
    found = [e for e, (_, count) in zip(ends, noticed, strict=True) if count >= PART * truth]
    return Played(
        tuple(count / truth for count in counts[:LOOKS]), found[0] if found else float("nan"),
        now, abs(outcome.count_error) / truth,
    )  # fmt: skip


def _dimmed(seen: Visibility, share: float) -> Visibility:
    return replace(seen, area=seen.area * share, weight=seen.weight * share)


def half_width(values: NDArray[np.float64]) -> float:
    """Half of the 95 % interval of a mean."""
    return float(1.96 * values.std(ddof=1) / len(values) ** 0.5)


def compared(less: Shown, more: Shown, seeds: Sequence[int]) -> list[tuple[str, float, float]]:
    """(what, mean gain of who sees more, its half-width): recall after each look, and the logarithm
    of how much sooner `PART` was noticed, where both noticed it."""
    a, b = ([play(shown, seed) for seed in seeds] for shown in (less, more))
    rows = []
    for k in range(LOOKS):
        gain = np.array([y.recall[k] - x.recall[k] for x, y in zip(a, b, strict=True)])
        rows.append((f"recall after {k + 1} looks", float(gain.mean()), half_width(gain)))
    sooner = np.array([np.log(x.found / y.found) for x, y in zip(a, b, strict=True)])
    sooner = sooner[np.isfinite(sooner)]
    if len(sooner) > 1:
        rows.append((f"sooner at {PART:.0%}", float(sooner.mean()), half_width(sooner)))
    return rows


PAIRS = (
    (Shown(0.3), Shown(0.6)),
    (Shown(0.6), Shown(0.9)),
    (Shown(0.9), Shown(1.0)),
    (Shown(0.9, 0.05), Shown(0.9, 0.3)),
    (Shown(0.9, 0.3), Shown(0.9, 1.0)),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print dominance pair by pair, then how times move along visibility."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS)
    seeds = range(parser.parse_args(arguments).seeds)
    for less, more in PAIRS:
        print(f"{less} against {more}")
        for what, gain, half in compared(less, more, seeds):
            print(f"  {what:24s}{gain:+.4f} ± {half:.4f}{'' if gain + half >= 0 else '  FAILS'}")
    print("visible part of views: seconds, |error|")
    for views in (0.02, 0.1, 0.3, 0.6, 0.9, 1.0):
        own = [play(Shown(views), seed) for seed in seeds[:200]]
        seconds, error = (np.mean([getattr(p, n) for p in own]) for n in ("seconds", "error"))
        print(f"  {views:4.2f}: {seconds:6.1f} {error:.3f}")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
