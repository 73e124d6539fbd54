"""`seethrough replay`: a trial again, from its log; read-only."""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.outputs import check_output
from seethrough.experiment.replay.replay_check import Pictures, differences, has_pictures
from seethrough.experiment.replay.replayer import Frame, Recorded, find_trial, replay

LOOKS_EVERY = 0.5  # s of session time between two rows of the visibility table


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", type=Path, metavar="DATA", help="a study's data folder")
    parser.add_argument("--participant", required=True, metavar="P")
    parser.add_argument("--trial", required=True, type=int, metavar="N")
    parser.add_argument("--attempt", type=int, metavar="A", help="default: the last")
    parser.add_argument("--verify", action="store_true", help="compare with the digests kept then")
    parser.add_argument("--video", type=Path, metavar="FILE.mp4", help="make a video")
    parser.add_argument("--visibility", type=Path, metavar="FILE.csv", help="targets over time")
    parser.add_argument("--speed", type=float, default=1.0, metavar="X", help="of watching")


def run(arguments: argparse.Namespace) -> int:
    """Replay; 0, or 1 where --verify found another picture than was shown."""
    check_output("--video", arguments.video, ".mp4")
    check_output("--visibility", arguments.visibility)
    for path in (arguments.video, arguments.visibility):
        if path is not None and path.exists():
            raise InputError(f"{path}: exists already; expected a new file")
    if not arguments.speed > 0:
        raise InputError(f"--speed = {arguments.speed:g}: expected a number above 0")
    recorded = find_trial(arguments.data, arguments.participant, arguments.trial, arguments.attempt)
    status = 0
    if arguments.verify:
        status = _verify(recorded)
    if arguments.visibility:
        _visibility(recorded, arguments.visibility)
    if arguments.video:
        from seethrough.experiment.replay.video import write_video

        write_video(recorded, arguments.video)
        print(f"video: {arguments.video}")
    if not (arguments.verify or arguments.visibility or arguments.video):
        _watch(recorded, arguments.speed)
    return status


def _verify(recorded: Recorded) -> int:
    """Compare all that was kept: the camera's way, the answer, and the pictures' digests."""
    different = found = pictures = 0
    drawn = Pictures(recorded) if has_pictures(recorded) else None
    for frame in replay(recorded):
        found += 1
        for line in differences(recorded, frame):
            different += 1
            print(line)
        if frame.digest and drawn is not None:
            pictures += 1
            if drawn.digest(frame) != frame.digest:
                different += 1
                print(f"frame at {frame.time:.3f} s: another picture than was shown")
    rest = f"the camera of {found} frames, and the answer; {different} different"
    if drawn is None:
        print(f"no picture was kept, since it was played without a window; compared: {rest}")
    else:
        print(f"{pictures} pictures compared, {rest}")
    return 1 if different else 0


def _visibility(recorded: Recorded, path: Path) -> None:
    """One row for each look and target: how much of it could be seen, how strongly."""
    from seethrough.experiment.display.driver import open_context
    from seethrough.experiment.display.looking import Looking

    looking = Looking(open_context(looks=True), recorded.size)
    looking.technique = recorded.technique
    with open(path, "x", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["time", "object", "kind", "pixels", "weight", "contrast"])
        for time_, frame in _thinned(replay(recorded), LOOKS_EVERY):
            seen, scene = looking.look(frame.view), frame.view.scene
            for i in np.nonzero(scene.targets)[0]:
                weight, contrast = float(seen.weight[i]), float(seen.contrast[i])
                values = [repr(v) if np.isfinite(v) else "" for v in (weight, contrast)]
                kind = scene.objects[i].kind
                table.writerow([repr(time_), int(i), kind, int(seen.pixels[i]), *values])
    print(f"visibility: {path}")


def _thinned(frames: Iterable[Frame], every: float) -> Iterable[tuple[float, Frame]]:
    """(seconds since the first frame, frame), at most one for each `every` seconds."""
    first = due = None
    for frame in frames:
        first = frame.time if first is None else first
        if due is None or frame.time >= due:
            due = frame.time + every
            yield frame.time - first, frame


def _watch(recorded: Recorded, speed: float) -> None:
    from seethrough.experiment.display.clock import RealClock
    from seethrough.experiment.display.window import Window

    study = recorded.study
    clock = RealClock(speed)
    window = Window(study.display, recorded.texts, clock, f"Replay of {recorded.trial.task}")
    try:
        _play(recorded, clock.now, window.show, window.left)
    finally:
        window.close()


def _play(
    recorded: Recorded,
    now: Callable[[], float],
    show: Callable[..., float],
    left: Callable[[], bool],
) -> None:
    """Show frames when they are due; those that are late are skipped."""
    start, first = now(), None
    for frame in replay(recorded):
        first = frame.time if first is None else first
        due = start + frame.time - first
        if now() > due + 0.1:
            continue
        while now() < due:
            time.sleep(0.001)
        show(frame.view, recorded.technique)
        if left():
            print("left", file=sys.stderr)
            return
