"""A technique in a picture of half the window's size: it shows what the window shows.

Widths in pixels are the window's and shrink with the picture (`Shot.scale`). What a pixel of the
small picture shows, the large one shows at one of the pixels about the same place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.suites.finding import Finding
from seethrough.experiment.suites.technique_hands import played
from seethrough.experiment.suites.technique_scenes import Case
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.reference.reference import exact

if TYPE_CHECKING:
    from collections.abc import Sequence

    from moderngl import Context

    from seethrough.renderer.techniques import base

WINDOW, HALF = (192, 144), (96, 72)
SCALE = HALF[1] / WINDOW[1]
STEP = 1.0  # of 255, from the reference: half of it rounding to 8 bits
ROUNDED = 2.0  # of 255, between two pictures: both are rounded to 8 bits, and one is shaded between
FINE = 0.01
"""Share of pixels that the window shows nothing like: things and lines thinner than a pixel, which
one picture meets and the other misses. Lines a pixel wide, everywhere, come to half of that."""
APART = 4.0
"""Of 255, between the means of the pictures' middles, where nothing has an edge: rounding, and one
of the 16 steps that a pattern of pixels may have its share in where it is not met whole."""


class Pair(NamedTuple):
    """The window's picture (2h, 2w, 3) and the one of half its size (h, w, 3)."""

    window: NDArray[np.uint8]
    half: NDArray[np.uint8]


def at_half(
    tried: Sequence[base.Parameters], cases: Sequence[Case], covered: Case, context: Context
) -> Finding:
    """With all these parameters: the half picture is the reference's, on each case in turn; and on
    the `covered` one it shows what the window shows."""
    worst, strange, apart, where = 0.0, [0.0], 0.0, ""
    for k, p in enumerate(tried):
        drawn, rules = p.technique.exactly(p), p.technique
        for case in (cases[k % len(cases)], covered):
            state = rules.begin(drawn) if k % 2 else played(rules, case, drawn)
            pair = Pair(*(_picture(case, drawn, state, size, context) for size in (WINDOW, HALF)))
            truth = exact(case.scene, case.camera, drawn, HALF, state, SCALE)
            off = np.abs(pair.half - truth.picture * 255).max(axis=2)[~truth.near_edge]
            own = float(off.max(initial=0.0))
            middle = middles_apart(pair) if case is covered else 0.0
            if own > max(worst, STEP) or middle > max(apart, APART):
                where = f" on {case.name}, {drawn}"
            worst, apart = max(worst, own), max(apart, middle)
            strange += [unlike(pair)] if case is covered else []
    share = float(np.mean(strange[1:]))
    said = (
        f"within {worst:.2f} of 255 of the reference; {100 * share:.2f} % of the pixels are like "
        f"none about them in the window, its middle differs by {apart:.2f} of 255"
    )
    holds = worst <= STEP and share <= FINE and apart <= APART
    return Finding("half size", holds, said if holds else said + where)


def _picture(
    case: Case, p: base.Parameters, state: object, size: tuple[int, int], context: Context
) -> NDArray[np.uint8]:
    renderer = Renderer(context, size, window=WINDOW[1])
    renderer.draw(case.scene, case.camera, p, state=state)
    return renderer.read()


def unlike(pair: Pair) -> float:
    """Share of the half picture's pixels that are darker or lighter, in a channel, than all of the
    4 × 4 pixels of the window about the same place."""
    wide = np.pad(pair.window.astype(float), ((1, 1), (1, 1), (0, 0)), mode="edge")
    about = np.lib.stride_tricks.sliding_window_view(wide, (4, 4), axis=(0, 1))[::2, ::2]
    low, high = about.min(axis=(-1, -2)) - ROUNDED, about.max(axis=(-1, -2)) + ROUNDED
    return float(((pair.half < low) | (pair.half > high)).any(axis=2).mean())


def middles_apart(pair: Pair) -> float:
    """By how much the mean colours of the pictures' middles differ, of 255."""
    means = [picture[_middle(picture.shape[:2])].mean(axis=(0, 1)) for picture in pair]
    return float(np.abs(means[0] - means[1]).max())


def _middle(shape: tuple[int, ...]) -> tuple[slice, slice]:
    """A third of a picture's height and width, whole cells of a pattern of 4 × 4."""
    rows, columns = ((n // 2 - n // 24 * 4, n // 2 + n // 24 * 4) for n in shape)
    return slice(*rows), slice(*columns)
