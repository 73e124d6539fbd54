"""The viewer's window under a real X server: keys, order stats on screen, and how it closes."""

import numpy as np
from desktop import Desktop, Program, wait_until
from PIL import Image
from player import ARTEFACTS, START, has_window

TITLE = "fence"


def shot(desktop, name):
    """The screen as (h, w, 3) integers."""
    path = ARTEFACTS / f"viewer-{name}.png"
    desktop.screenshot(path)
    with Image.open(path) as picture:
        return np.asarray(picture.convert("RGB")).astype(int)


def changed(one, other):
    """Pixels that differ."""
    return int((np.abs(one - other).max(axis=2) > 8).sum())


def test_keys_change_the_picture_and_stats_stay_on_screen(tmp_path):
    with (
        Desktop() as desktop,
        Program(desktop, tmp_path / "log", "view", "fence", "--order", "feudal") as program,
    ):
        shown = lambda: has_window(desktop, TITLE) or not program.running()  # noqa: E731
        wait_until(shown, START, "the window")
        assert program.running(), program.said()
        # Text in the upper left corner: dark on light, and nothing of the scene reaches there.
        stats = lambda s: int((s[:110, :420].max(axis=2) < 100).sum())  # noqa: E731
        wait_until(lambda: stats(shot(desktop, "start")) > 500, START, "the stats")
        now = shot(desktop, "start")
        for key, least in (("t", 1000), ("o", 10_000), ("l", 1000), ("p", 1000), ("Left", 1000)):
            before = now
            desktop.keys(key)
            wait_until(
                lambda k=key, b=before, n=least: changed(b, shot(desktop, k)) > n, 20, f"key {key}"
            )
            now = shot(desktop, key)
            assert stats(now) > 500
        desktop.keys("Escape")
        wait_until(lambda: not program.running(), 20, "the end")
        assert program.process.returncode == 0, program.said()
        assert program.said() == ""
