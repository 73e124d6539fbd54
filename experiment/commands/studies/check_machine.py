"""What `check` says of this machine: whether it draws the hardest scene in time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.config import Study
from seethrough.experiment.verdicts import FAILS, OK, WARNING, Verdicts
from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.techniques.standard.opaque import Standard

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.experiment.session.machine import FrameTimes
    from seethrough.experiment.study.checked.certificate import Difficulty


LEAST_DISK = 1.0  # GiB
SMOOTH, HOPELESS = 0.01, 0.5  # shares of frames missed: above the first a warning, the last fails


def check_machine(
    study: Study, measured: list[Difficulty], context: Context, seconds: float, said: Verdicts
) -> None:
    """Frame times where they are worst: the scenes with most to see through, of each world with
    each technique."""
    from seethrough.experiment.session.machine import crossings, frame_times, free_disk
    from seethrough.renderer.polygons.prepared import DENSE_CROSSINGS

    drawn: dict[tuple[str, object], list[Difficulty]] = {}
    for d in measured:
        part = study.part(d.trial.levels)
        if part.technique != Standard() or len(study.parts) == 1:
            drawn.setdefault((part.world, part.technique), []).append(d)
    for (world, _), own in drawn.items():
        hardest = max(own, key=lambda d: (d.occluders, d.targets))
        part = study.part(hardest.trial.levels)
        try:
            times = frame_times(study, hardest.trial, context, seconds)
        except CannotDraw as error:
            said.say("machine", f"{world}, {part.technique_name}", FAILS, str(error))
            continue
        rate = part.display.refresh
        text = (
            f"{world}, {part.technique_name}: {times.frames} frames of {hardest.trial.scene}, "
            f"median {times.median:.1f} ms, 99 % within {times.p99:.1f} ms; "
            f"{100 * times.missed:.1f} % over 1.5 periods of {rate:g} Hz"
        )
        said.say("machine", text, *smooth(times, rate))
        for line in crossings(study, hardest.trial):
            dense = [WARNING, "expected fewer crossings"] if DENSE_CROSSINGS in line else []
            said.say("machine", f"{world}, objects that intersect: {line}", *dense)
    _refresh(study, said)
    free = free_disk(Path.cwd())
    enough = [] if free > LEAST_DISK else [FAILS, f"expected {LEAST_DISK:g} GiB or more"]
    said.say("machine", f"free disk: {free:.1f} GiB", *enough)


def smooth(times: FrameTimes, rate: float) -> tuple[str, str]:
    """The verdict on frame times, and why. Where more frames are missed than not, the display's
    rate is out of reach: nobody should be run on this machine."""
    if times.missed > HOPELESS:
        return (
            FAILS,
            f"{rate:g} Hz is out of reach here ({1000 / times.median:.0f} frames a second): "
            "expected a graphics card, a smaller window or an easier scene",
        )
    if times.missed > SMOOTH:
        return WARNING, f"expected at most {100 * SMOOTH:g} % missed; the report counts them"
    return OK, ""


def _refresh(study: Study, said: Verdicts) -> None:
    """Measured against declared refresh rate, where there is a display."""
    from seethrough.experiment.display.system_window import available

    if not available():
        why = "no display: simulated people only, and the refresh rate was not measured"
        said.say("machine", "window: none can be opened", WARNING, why)
        return
    from seethrough.experiment.display import refresh
    from seethrough.experiment.display.clock import RealClock
    from seethrough.experiment.display.window import Window

    window = Window(study.display, Texts("en"), RealClock(), "check")
    rate, declared = window.measured, window.declared
    window.close()
    right = [] if refresh.fits(rate, declared) else [FAILS, "write the measured one into [display]"]
    said.say("machine", f"refresh: {refresh.said(rate, declared)}", *right)
