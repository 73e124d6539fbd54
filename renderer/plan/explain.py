"""A plan in words: which effects a frame needs, for which objects, and why not the others."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.plan import clusters
from seethrough.renderer.plan.frame_plan import (
    BLENDED,
    HARD,
    OPAQUE,
    OUTSIDE,
    RULED,
    SHORTCUTS,
    UNSEEN,
    FramePlan,
)
from seethrough.renderer.scene.scene import Scene

REASONS = {
    OUTSIDE: "not drawn: outside the view",
    UNSEEN: "not drawn: no doorway on any way there shows it",
    OPAQUE: "opaque, in one pass with all such: in front of no mask",
    HARD: "opaque, in one pass with all such: impenetrable",
    BLENDED: "blended",
    RULED: "drawn as the technique's rule has it: it may hide something that is asked for",
}


def explain(scene: Scene, frame: FramePlan) -> list[str]:
    """Lines for a reader: the frame as a whole, then every object, then every target."""
    lines = _whole(frame)
    lines += [of_cluster(scene, members) for members in frame.clusters]
    lines += [_of_object(scene, frame, i) for i in range(len(scene.objects))]
    lines += [_of_target(scene, frame, int(t)) for t in np.nonzero(scene.targets)[0]]
    return lines


def name(scene: Scene, i: int) -> str:
    """An object in words."""
    kind = scene.objects[i].kind or "object"
    return f"{kind} {i}"


def _whole(frame: FramePlan) -> list[str]:
    counts = {reason: int((frame.reasons == reason).sum()) for reason in REASONS}
    lines = [f"{count} objects {REASONS[reason]}" for reason, count in counts.items() if count]
    if len(frame.ruled):
        return lines
    if not frame.levels and not len(frame.exact):
        lines.append("no target in view has anything penetrable in front: the standard frame")
    if frame.levels:
        levels = sum(1 for level in frame.levels if len(level.objects))
        lines.append(f"{frame.ordered} objects put in order, drawn in {levels} levels")
    if len(frame.crossing):
        lines.append(
            f"{len(frame.crossing)} pairs of targets that cross, one drawn within the other"
        )
    if len(frame.straddling):
        lines.append(
            f"{len(frame.straddling)} borders of masks told by depth from what straddles them"
        )
    if len(frame.swapping):
        lines.append(
            f"{len(frame.swapping)} pairs whose order is about to turn round, one drawn behind the "
            "other as well"
        )
    if len(frame.wide):
        lines.append(f"{len(frame.wide)} large objects blended only where masks are")
    if len(frame.exact):
        pixels = (frame.exact[:, 2:] - frame.exact[:, :2]).prod(axis=1).sum()
        lines.append(f"{len(frame.exact)} parts sorted by pixel, {pixels} pixels")
    lines.append(f"{len(frame.masked)} masks, {len(frame.counted)} with layers counted")
    taken = [s for s in SHORTCUTS if s not in frame.without]
    lines.append(f"shortcuts taken: {', '.join(taken) or 'none'}")
    return lines


def of_cluster(scene: Scene, members: NDArray[np.int64]) -> str:
    """What cutting a cluster's polygons along one another made of them."""
    tree = clusters.tree_of(scene, members)
    names = ", ".join(name(scene, i) for i in members.tolist())
    if isinstance(tree, str):
        return f"{names}: {tree}"
    stats = tree.stats
    return f"{names}: {stats.inputs} polygons cut into {stats.outputs}" + (
        f"; {stats.dense}" if stats.dense else ""
    )


def _of_object(scene: Scene, frame: FramePlan, i: int) -> str:
    reason = int(frame.reasons[i])
    text = f"{name(scene, i)}: {REASONS[reason]}"
    if reason != BLENDED:
        return text
    if frame.behind[i] >= 0:
        text += f", in front of {name(scene, int(frame.behind[i]))}"
    elif not len(frame.exact):
        text += ", so that it comes in order with others that blend"
    level = next((k for k, level in enumerate(frame.levels) if i in level.objects), None)
    if level is not None:
        text += f", level {level}"
    for pair in frame.crossing[(frame.crossing == i).any(axis=1)].tolist():
        text += f", crosses {name(scene, pair[pair[0] == i])}"
    for _, target, _ in frame.straddling[frame.straddling[:, 0] == i].tolist():
        text += f", told by depth from the border of {name(scene, target)}"
    if not scene.objects[i].mesh.convex:
        text += ", depth first (not convex)"
    return text


def _of_target(scene: Scene, frame: FramePlan, t: int) -> str:
    text = f"{name(scene, t)}: "
    if len(frame.ruled):
        return text + "not touched: a target"
    if t in frame.masked:
        text += "mask"
        return text + (", layers counted" if t in frame.counted else "")
    if frame.reasons[t] == OUTSIDE:
        return text + "no mask: outside the view"
    return text + "no mask: nothing penetrable in front"
