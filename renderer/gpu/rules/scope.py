"""What of the picture the objects of a rule can cover."""

from __future__ import annotations

from math import ceil, floor

from seethrough.renderer.errors import CannotDraw
from seethrough.renderer.plan.frame_plan import FramePlan
from seethrough.renderer.techniques.maps import BLOCK

Scope = tuple[int, int, int, int]  # as OpenGL has it: x, y (up), width, height


def scope_of(frame: FramePlan, size: tuple[int, int]) -> Scope:
    """The rectangle about the plan's ruled objects, in pixels, at least one of them."""
    boxes = frame.boxes.extents[frame.ruled]
    low, high = boxes[:, :2].min(axis=0).tolist(), boxes[:, 2:].max(axis=0).tolist()
    # As plain numbers: numpy takes as long for four of them as for all boxes.
    left, top = (max(floor(min(max(x, 0), s + 1)) - 1, 0) for x, s in zip(low, size, strict=True))
    right, bottom = (min(ceil(min(max(x, -1), s)) + 1, s) for x, s in zip(high, size, strict=True))
    return (left, size[1] - bottom, max(right - left, 1), max(bottom - top, 1))


def looked_up(frame: FramePlan, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """Left, top, right, bottom in pixels of whole blocks about the plan's ruled objects and the
    pixels beside them."""
    x, y, width, height = around(scope_of(frame, size), size)
    left, top, right, bottom = x, size[1] - y - height, x + width, size[1] - y
    return (
        *(left // BLOCK * BLOCK, top // BLOCK * BLOCK),
        *(min(-(-right // BLOCK) * BLOCK, size[0]), min(-(-bottom // BLOCK) * BLOCK, size[1])),
    )


def around(scope: Scope, size: tuple[int, int]) -> Scope:
    """The rectangle and the pixels beside it, as far as the picture goes."""
    x, y, width, height = scope
    left, low = max(x - 1, 0), max(y - 1, 0)
    return (left, low, min(x + width + 1, size[0]) - left, min(y + height + 1, size[1]) - low)


def halves(scope: Scope) -> list[Scope]:
    """A rectangle in two, one over the other; beside each other where it is one pixel high. Raises
    CannotDraw for a single pixel."""
    x, y, width, height = scope
    if height > 1:
        return [(x, y, width, height // 2), (x, y + height // 2, width, height - height // 2)]
    if width > 1:
        return [(x, y, width // 2, 1), (x + width // 2, y, width - width // 2, 1)]
    raise CannotDraw("more surfaces at one pixel than a buffer of the driver holds")
