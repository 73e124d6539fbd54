"""A trial as a video: its frames at 30 a second, drawn offscreen, HUD and all."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from seethrough.experiment.display.driver import open_context
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.errors import InputError
from seethrough.experiment.replay.replayer import Recorded, replay

RATE = 30


def write_video(recorded: Recorded, path: Path) -> None:
    """Encode the trial as H.264. Raises InputError where the encoder is not installed, or cannot
    write."""
    try:
        import imageio_ffmpeg
    except ImportError:
        raise InputError(
            "--video: needs the package imageio-ffmpeg; install the extra `video`"
        ) from None
    try:
        path.open("xb").close()  # the encoder would say it later, in many lines
    except OSError as error:
        raise InputError(f"--video = {path}: cannot be written: {error.strerror}") from None
    context = open_context()
    stage = Stage(context, recorded.size, recorded.texts)
    texture = context.texture(recorded.size, 4)
    target = context.framebuffer([texture])
    width, height = recorded.size
    # The codec wants even sizes: an odd last row or column is left out.
    even = (width - width % 2, height - height % 2)
    writer = imageio_ffmpeg.write_frames(
        str(path), even, fps=RATE, macro_block_size=2, ffmpeg_log_level="quiet"
    )
    writer.send(None)
    try:
        first, sent = None, 0
        for frame in replay(recorded):
            first = frame.time if first is None else first
            wanted = int((frame.time - first) * RATE) + 1
            if wanted <= sent:
                continue
            stage.draw_view(frame.view, recorded.technique, target, 1 / RATE)
            pixels = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
            picture = pixels.reshape(height, width, 3)[::-1][: even[1], : even[0]]
            for _ in range(wanted - sent):
                writer.send(np.ascontiguousarray(picture))
            sent = wanted
    except OSError:  # the encoder ended before its input
        raise InputError(f"--video = {path}: cannot be written to its end") from None
    finally:
        writer.close()
