"""What simulated people do at the tasks: `python tests/support/performance_figures.py` writes it
anew (tests/data/people/performances.json).

With eyes that see what a test lets them see: no graphics card has a say. Who plays, and how,
is changed on purpose, in a commit of its own, which writes these figures with it: whoever simulates
a study again is to get its rows again.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from plain_trials import play
from played_tasks import PUBLISHED

from seethrough.renderer.events import PointerMove, PointerPress
from seethrough.tasks.kit.skills.profile import PROFILES

FIGURES = Path(__file__).resolve().parents[1] / "data" / "people" / "performances.json"
PLAYED = [(task, seed, name) for task in PUBLISHED for seed in (11, 12, 13)
          for name in ("average", "hasty")]  # fmt: skip


def figures(task, seed, name):
    """The answer, how long it took, and what was done: how many events of each kind, their times,
    and where the pointer went."""
    outcome, seconds, events, _ = play(task, seed, profile=PROFILES[name])
    kinds = [type(e).__name__ for e in events]
    times = np.array([e.time for e in events])
    moves = np.array([(e.dx, e.dy) for e in events if isinstance(e, PointerMove)]).reshape(-1, 2)
    at = np.array([(e.x, e.y) for e in events if isinstance(e, PointerPress)]).reshape(-1, 2)
    return {
        "answer": outcome.answer,
        "truth": outcome.truth,
        "correct": bool(outcome.correct),
        "seconds": float(seconds),
        "events": {kind: kinds.count(kind) for kind in sorted(set(kinds))},
        "keys": "".join(f"{e.key} " for e in events if hasattr(e, "key"))[-120:],
        "times": [float(times.sum()), float(np.square(times).sum())],
        "moves": [*moves.sum(axis=0).tolist(), *np.abs(moves).sum(axis=0).tolist()],
        "presses": at.sum(axis=0).tolist(),
    }


def everything():
    """{task, seed and profile: figures}."""
    return {" ".join(map(str, played)): figures(*played) for played in PLAYED}


if __name__ == "__main__":
    FIGURES.parent.mkdir(exist_ok=True)
    rows = [f"{json.dumps(k)}: {json.dumps(v)}" for k, v in everything().items()]
    FIGURES.write_text("{\n" + ",\n".join(rows) + "\n}\n", encoding="utf-8")
