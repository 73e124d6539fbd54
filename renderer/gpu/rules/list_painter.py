"""Draws surfaces that show through one another in one pass: each pixel gathers a list of what the
rule keeps there, then its list is put in order and added up from the front.

Layer by layer (peel_painter.py) all is drawn again for each layer.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

import moderngl
import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.gpu.device import pipeline
from seethrough.renderer.gpu.device.targets import FrameTarget
from seethrough.renderer.gpu.rules.list_blocks import ListBlocks
from seethrough.renderer.gpu.rules.lists import WORDS, Lists
from seethrough.renderer.gpu.rules.removal_painter import RemovalPainter
from seethrough.renderer.gpu.rules.rule_program import Ruled
from seethrough.renderer.gpu.rules.scope import Scope, halves, scope_of
from seethrough.renderer.scene.visibility import Drawn

MOST = 10_000  # layers that count, where a technique has no limit
OPAQUE = 0.9999  # what lies behind so much opacity is not seen


class ListPainter:
    """Keeps programs and buffers. `found` are the layers of the last frame drawn with ids."""

    def __init__(self, context: moderngl.Context, defines: Sequence[str]) -> None:
        self._ids = "WITH_IDS" in defines
        self._lists = Lists(context, defines)
        self._solids = RemovalPainter(context, ["SOLID", *defines])
        self._blocks = ListBlocks(context)
        self._sum = self._blocks.program("lists.frag", WORDS)
        self.found: list[Drawn] = []

    def draw(self, ruled: Ruled, target: FrameTarget) -> int:
        """Draw the plan's ruled objects over those already in the target. Returns the draws."""
        most = ruled.technique.technique.layers(ruled.technique)
        # Where pixels have several samples, what is opaque needs them all: a list is of the middle
        # of its pixel, and beside a neighbour that no rule is asked about, what is behind both
        # would show. A limited number of layers counts what is opaque among them.
        solid = target.resolved is not target.framebuffer and most is None
        draws = self._solids.draw(ruled, target) if solid else 0
        frame = self._lists.begin(ruled, target, solid)
        parts, found = [scope_of(ruled.frame, target.size)], list[list[Drawn]]()
        while parts:
            part = parts.pop()
            count = self._lists.gather(frame, part)
            draws += len(frame.runs)
            if count > self._lists.limit:
                parts += halves(part)  # what one buffer cannot hold is drawn in two parts
                continue
            heads = self._lists.heads()
            if self._ids:
                found.append(_layers(self._lists.read(count), heads, target.size, most))
            self._add_up(heads, part, target, MOST if most is None else most)
        self.found = [_joined(layers) for layers in zip_longest(*found)]
        return draws

    def _add_up(
        self, heads: NDArray[np.uint32], scope: Scope, target: FrameTarget, most: int
    ) -> None:
        """Add up the lists of a part of the picture over what is there, and take them away."""
        self._blocks.find(heads, target.size, scope)
        self._sum.set(width=target.size[0], most=most, enough=OPAQUE)
        self._blocks.draw(self._sum, target.framebuffer, pipeline.OVER)


def _layers(
    lists: NDArray[np.uint32],
    heads: NDArray[np.uint32],
    size: tuple[int, int],
    most: int | None,
) -> list[Drawn]:
    """From the front: where each layer shows something, what, and how strongly."""
    pixel = np.zeros(len(lists), np.int64)
    here = np.nonzero(heads)[0]
    at = heads[here].astype(np.int64) - 1
    while len(at):
        pixel[at] = here
        following = lists[at, 0].astype(np.int64)
        here, at = here[following > 0], following[following > 0] - 1
    depth, thing = lists[:, 1], lists[:, 4].astype(np.int64)
    opacity = np.ascontiguousarray(lists[:, 3]).view(np.float16).reshape(-1, 2)[:, 1]
    order = np.lexsort((-thing, depth, pixel))
    pixel, thing, opacity = pixel[order], thing[order], opacity[order].astype(np.float32)
    starts = np.searchsorted(pixel, pixel)
    rank = np.arange(len(pixel)) - starts
    across, up = pixel % size[0], pixel // size[0]
    pixel = (size[1] - 1 - up) * size[0] + across
    shown = np.zeros(size[0] * size[1])
    found: list[Drawn] = []
    for k in range(int(rank.max(initial=-1)) + 1):
        if most is not None and k >= most:
            break
        rows = np.nonzero((rank == k) & (shown[pixel] < OPAQUE))[0]
        where = np.argsort(pixel[rows], kind="stable")
        rows = rows[where]
        shown[pixel[rows]] += (1 - shown[pixel[rows]]) * opacity[rows]
        found.append((pixel[rows], thing[rows] + 1, opacity[rows]))
    return found


def _joined(layers: Sequence[Drawn | None]) -> Drawn:
    """One layer of the parts of a picture."""
    there = [layer for layer in layers if layer is not None]
    where, things, opacity = (np.concatenate(column) for column in zip(*there, strict=True))
    return where, things, opacity
