"""What of a replayed trial can be held against its record: camera, answer, pictures."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import asdict

from seethrough.experiment.display.driver import open_context
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.record.record_files import cell
from seethrough.experiment.replay.replayer import Frame, Recorded


def has_pictures(recorded: Recorded) -> bool:
    """Whether digests of pictures were kept: a session without a window draws none."""
    with open(recorded.camera, encoding="utf-8", newline="") as file:
        return any(row["digest"] for row in csv.DictReader(file))


def differences(recorded: Recorded, frame: Frame) -> Iterator[str]:
    """A line for each value that the replay makes other than the record has it."""
    if frame.camera:
        camera = frame.view.camera
        made = tuple(float(v) for v in (*camera.eye, *camera.forward))
        if made != frame.camera:
            yield f"frame at {frame.time:.3f} s: another camera than was recorded"
    if frame.outcome is not None:
        for name, value in asdict(frame.outcome).items():
            if name in recorded.row and cell(value) != recorded.row[name]:
                yield f"{name} = {recorded.row[name]!r}: the replay makes {cell(value)!r}"


class Pictures:
    """Draws frames as the session did."""

    def __init__(self, recorded: Recorded) -> None:
        self._recorded = recorded
        context = open_context()
        driver = context.info["GL_RENDERER"]
        if driver != recorded.driver:
            print(f"recorded with {recorded.driver}, drawn with {driver}: pictures may differ")
        texts = recorded.texts
        self._stage = Stage(context, recorded.size, texts, recorded.samples)
        self._target = context.framebuffer([context.texture(recorded.size, 4)])

    def digest(self, frame: Frame) -> str:
        """The digest of a frame's picture."""
        self._stage.draw_view(frame.view, self._recorded.technique, self._target, 1 / 60)
        return self._stage.digest()
