"""What a frame needs, with reasons: which effects, for which objects, in which order.

An object in front of no target's mask is drawn opaque with all the others, in one pass. The rest
is put into levels: objects of one level do not overlap on the screen, so each level is a handful
of instanced draws, and their number grows with depth complexity instead of with the objects.
Where no order of objects is right, that part of the picture is sorted pixel by pixel.
"""

from __future__ import annotations

from collections.abc import Set
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from seethrough.renderer.arrays import Bools, Floats, Ints, Signs
from seethrough.renderer.masks import masks
from seethrough.renderer.plan import clusters, crossing, gathering, levels, order, straddling
from seethrough.renderer.plan import swapping as swaps
from seethrough.renderer.plan.blending import Blending, merged_parts
from seethrough.renderer.plan.comparing import IN_FRONT
from seethrough.renderer.plan.doubt import union
from seethrough.renderer.plan.frame_plan import (
    BLENDED,
    HARD,
    OPAQUE,
    OUTSIDE,
    RULED,
    UNSEEN,
    FramePlan,
    Level,
)
from seethrough.renderer.plan.outside import holes, wide
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import Boxes, screen_boxes
from seethrough.renderer.scene.rooms import seen as seen_through_doorways
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.base import MASKS, Parameters, Shot
from seethrough.renderer.techniques.dynamic.dynamic_transparency import (
    DynamicTransparency,
    by_masks,
)

SORTED = 24  # pixels to sort more for a triangle less


def impenetrable(scene: Scene, camera: Camera, technique: DynamicTransparency) -> Bools:
    """(n,) what never turns transparent in this frame (Elmqvist2009 §III-C.3)."""
    if technique.penetrable_within is None:
        return scene.impenetrable
    low, high = scene.corners.min(axis=1), scene.corners.max(axis=1)
    gap = np.maximum(np.maximum(low - camera.eye, camera.eye - high), 0.0)
    return scene.impenetrable | (np.linalg.norm(gap, axis=1) > technique.penetrable_within)


def plan(
    scene: Scene,
    camera: Camera,
    technique: Parameters,
    size: tuple[int, int],
    without: Set[str] = frozenset(),
    scale: float = 1.0,
    state: object = None,
) -> FramePlan:
    """Decide what the frame of `size` (width, height) in pixels needs. Pure.

    `without` names SHORTCUTS not to take; `scale` shrinks the width of masks with the picture;
    `state` is what events have made of the technique's.
    """
    boxes = screen_boxes(scene.corners, camera, size, scene.around)
    drawn = np.nonzero(boxes.inside | ("cull" in without))[0]
    if technique.technique.painter != MASKS:
        rules, shot = technique.technique, Shot(scene, camera, size, scale, covered=boxes)
        state = rules.begin(technique) if state is None else state
        touched = rules.touches(technique, state, shot)
        return _ruled(_opaque(boxes, drawn, without), touched, shot)
    technique = by_masks(technique)
    if not (scene.targets & boxes.within).any() and "opaque" not in without:
        return _in_rooms(_opaque(boxes, drawn, without), scene, camera, size)
    width = technique.width * scale
    reach = masks.reach(boxes.extents, technique, width, size)
    hard = impenetrable(scene, camera, technique)
    seen = _far_to_near(scene, camera, _reaching(scene, boxes, reach, size, without))
    there = np.zeros(len(hard), dtype=bool)
    there[seen] = True
    slanted = masks.reach_of_slants(boxes.slants, reach, technique, width)
    placed = order.Placed(
        seen=seen,
        extents=np.concatenate([boxes.extents, boxes.slants], axis=1),
        reach=np.concatenate([reach, slanted], axis=1),
        centers=scene.centers - camera.eye,
        sides=scene.box_sides,
        radius=scene.radii,
        near=boxes.near,
        far=boxes.far,
        targets=scene.targets,
        hard=hard,
    )
    near_by = order.near_each_other(placed)
    blend = there & ~hard & ("opaque" in without)
    mask = np.zeros_like(blend)
    across = straddling.NO_ONE
    if crossing.fits(technique) and not technique.per_pixel_only:
        across = straddling.found(*(scene, camera, placed, near_by, boxes, technique, width, size))
        blend, mask = straddling.shown(across, blend, mask)
    relation, uncertain, blended, masked = _decided(
        *(scene, camera, technique, placed, near_by, blend, mask)
    )
    masked |= there & scene.targets & ("masks" in without)
    if technique.per_pixel_only:
        masked |= order.overlapped(placed)
    base = FramePlan(
        opaque=drawn,
        levels=(),
        masked=np.nonzero(masked)[0],
        counted=_counted(relation, masked, technique),
        exact=np.zeros((0, 4), np.int64),
        boxes=boxes,
        reach=reach,
        reasons=_reasons(boxes, hard, blended),
        relation=relation,
        without=frozenset(without),
    )
    if not masked.any() and not blended.any():
        return _in_rooms(base, scene, camera, size)
    if technique.per_pixel_only:
        parts = _parts(reach[masked], technique, size, without)
        return _held(base, parts, scene.triangle_counts, size)
    # Of two targets that no plane separates one is lost where it lies behind, whoever goes first.
    lost = uncertain & (blended & masked) & (blended & masked)[:, None]
    lost |= _beside(scene, camera, technique, boxes, relation, masked)
    what = Blending(seen, placed.extents, placed.reach, relation, uncertain, blended, masked, lost)
    pairs = crossing.NONE
    if "crossing" not in without and crossing.fits(technique):
        pairs = crossing.pairs(what, scene, boxes, hard)
    return _with_levels(base, what, scene, camera, technique, size, pairs, across)


def _decided(
    scene: Scene, camera: Camera, technique: DynamicTransparency, placed: order.Placed,
    near_by: Ints, blend: Bools, mask: Bools,
) -> tuple[Signs, Bools, Bools, Bools]:  # fmt: skip
    """order.decide, again if planes were found between pairs that it is uncertain of."""
    by_center = technique.order == "centers"
    planes = scene.separations
    while True:
        relation, uncertain, blended, masked = order.decide(
            placed, near_by, blend, mask, planes.relation(camera.eye), by_center
        )
        new = uncertain & ~planes.tried
        if not new.any() or not planes.learn(np.argwhere(np.triu(new)), scene):
            return relation, uncertain & ~scene.settled, blended, masked


def _beside(
    scene: Scene, camera: Camera, technique: DynamicTransparency, boxes: Boxes,
    relation: Signs, masked: Bools,
) -> Bools:  # fmt: skip
    """(n, n) which targets lie before a mask, and reach to both sides of the depth that it has
    beside its own target. Outlines have too little there for that to matter."""
    if technique.mask in ("outline", "ring"):
        return np.zeros_like(relation, dtype=bool)
    depth = camera.depth(scene.centers)
    across = (boxes.near[:, None] < depth) & (boxes.far[:, None] > depth)
    return across & scene.targets[:, None] & masked & (relation == IN_FRONT)


def _opaque(boxes: Boxes, drawn: Ints, without: Set[str]) -> FramePlan:
    """Everything with a depth buffer."""
    none = drawn[:0]
    reasons = np.where(boxes.inside, OPAQUE, OUTSIDE)
    return FramePlan(
        *(drawn, (), none, none, np.zeros((0, 4), np.int64), boxes, boxes.extents, reasons),
        without=frozenset(without),
    )


def _in_rooms(frame: FramePlan, scene: Scene, camera: Camera, size: tuple[int, int]) -> FramePlan:
    """A plan that draws everything opaque, without what walls hide."""
    if "rooms" in frame.without or scene.rooms is None or scene.in_room is None:
        return frame
    extents = frame.boxes.extents
    seen = seen_through_doorways(scene.rooms, scene.in_room, extents, camera, size)
    reasons = np.where(seen | (frame.reasons == OUTSIDE), frame.reasons, UNSEEN)
    return replace(frame, opaque=frame.opaque[seen[frame.opaque]], reasons=reasons)


def _ruled(frame: FramePlan, touched: Bools, shot: Shot) -> FramePlan:
    """The plan with what the technique's rule may touch set apart from the opaque rest."""
    ruled = touched[frame.opaque]
    if not ruled.any():
        return _in_rooms(frame, shot.scene, shot.camera, shot.size)
    reasons = np.where(touched & (frame.reasons == OPAQUE), RULED, frame.reasons)
    rest, own = frame.opaque[~ruled], frame.opaque[ruled]
    return replace(frame, opaque=rest, ruled=own, reasons=reasons, shot=shot)


def _fit(scene: Scene, technique: DynamicTransparency) -> Bools:
    """(n,) which objects may be drawn polygon by polygon. Layers are counted by object alone."""
    if technique.order != "polygons" or technique.min_transmittance > 0:
        return np.zeros(len(scene.objects), dtype=bool)
    return clusters.fitting(scene)


def _has_tree(scene: Scene, members: Ints) -> bool:
    """Whether the polygons of a cluster can be cut along one another; else pixels are sorted."""
    return not isinstance(clusters.tree_of(scene, members), str)


def _reaching(
    scene: Scene, boxes: Boxes, reach: Floats, size: tuple[int, int], without: Set[str]
) -> Ints:
    """What can change the picture: objects in view, and targets whose mask reaches into it."""
    reaching = order.touching(reach, size) & scene.targets & boxes.within
    return np.flatnonzero(boxes.inside | reaching | (boxes.within & ("cull" in without)))


def _far_to_near(scene: Scene, camera: Camera, objects: Ints) -> Ints:
    """Farthest group first, by view depth; a group stays together, in its order in the scene."""
    return order.far_to_near(objects, scene.group_of, camera.depth(scene.group_centers))


def _counted(relation: Signs, masked: Bools, technique: DynamicTransparency) -> Ints:
    """Targets with more objects in front than may each keep alpha_target (notation: Elmqvist2009
    §V-D)."""
    tau, alpha = technique.min_transmittance, technique.alpha_target
    if tau == 0:
        return np.zeros(0, np.int64)
    allowed = np.inf if alpha == 0 else (0 if alpha == 1 else np.log(tau) / np.log(1 - alpha))
    in_front = (relation == IN_FRONT).sum(axis=0)
    return np.nonzero(masked & (in_front > np.floor(allowed + 1e-12)))[0]


def _reasons(boxes: Boxes, hard: Bools, blended: Bools) -> Ints:
    reasons = np.where(blended, BLENDED, np.where(hard, HARD, OPAQUE))
    return np.where(boxes.inside, reasons, OUTSIDE)


def _with_levels(
    base: FramePlan,
    what: Blending,
    scene: Scene,
    camera: Camera,
    technique: DynamicTransparency,
    size: tuple[int, int],
    pairs: Ints,
    across: straddling.Straddling,
) -> FramePlan:
    """The plan with blended objects and masks in levels, and the parts that no order gets right.
    `pairs` are the targets that could be drawn one within the other; `across` is what straddles the
    border of a mask."""
    opaque, masked = ~what.blended, what.masked
    triangles, doubt = scene.triangle_counts, technique.doubt
    fit = _fit(scene, technique) & ~masked
    united = clusters.unite(
        *(what.extents, what.relation, what.uncertain, what.blended, fit, triangles),
        partial(_has_tree, scene),
    )
    seen = what.seen[united.blended[what.seen] | masked[what.seen]]
    what = Blending(
        *(seen, united.extents, what.reach, united.relation, united.uncertain, united.blended),
        masked,
        what.lost,
    )
    part_by_part = "parts" not in base.without
    with_pairs = crossing.in_order(what, pairs)
    ordered = with_pairs.ordered(size, doubt, part_by_part)
    if len(pairs) and len(ordered.doubtful):  # what lies between the two may be drawn wrongly then
        without = what.ordered(size, doubt, part_by_part)
        if union(without.doubtful) <= union(ordered.doubtful):
            pairs, with_pairs, ordered = crossing.NONE, what, without
    if ordered.much:
        return _held(base, what.parts(size), triangles, size)
    of_object, of_mask, doubtful = ordered.of_object, ordered.of_mask, ordered.doubtful
    if "levels" in base.without:
        of_object, of_mask = levels.one_by_one(seen, of_object, of_mask)
    elif not ordered.broken:
        of_object, of_mask = gathering.gathered(
            with_pairs.related, scene.mesh_of, scene.convex, of_object, of_mask
        )
    parts = merged_parts(doubtful, size)
    if len(parts) and not part_by_part:
        parts, doubtful = np.array([[0, 0, *size]]), doubtful[:0]
    keep = np.zeros(len(masked), dtype=bool)
    keep[base.opaque] = True
    around = holes(base.reach, base.masked, size)
    apart = united.clustered
    apart[pairs] = True
    told, strength = straddling.kept(across, of_object, of_mask, apart)
    swapping, beyond = swaps.swapping(what, scene, camera, base.boxes, of_object, apart)
    apart[told[:, 0]] = apart[swapping[:, 0]] = True
    alone = np.nonzero(what.blended & ~apart)[0]
    return replace(
        base,
        opaque=np.nonzero(keep & opaque)[0],
        levels=_levels(of_object, of_mask),
        crossing=pairs[np.argsort(of_object[pairs[:, 1]], kind="stable")],
        straddling=told,
        strength=strength,
        swapping=swapping,
        beyond=beyond,
        exact=parts,
        doubtful=doubtful,
        wide=alone[:0]
        if "outside" in base.without
        else wide(base.boxes.extents, alone, around, triangles, size),
        holes=around,
        clusters=united.members,
    )


def _levels(of_object: Ints, of_mask: Ints) -> tuple[Level, ...]:
    """The levels, from what level each object and each mask has."""
    last = max(int(of_object.max(initial=-1)), int(of_mask.max(initial=-1)))
    parts = zip(_grouped(of_object, last), _grouped(of_mask, last), strict=True)
    return tuple(Level(objects, targets) for objects, targets in parts)


def _grouped(level: Ints, last: int) -> list[Ints]:
    """The objects of each level from −1 to `last`, in their order."""
    objects, starts = levels.grouped(level, last)
    return [objects[a:b] for a, b in pairwise(starts.tolist())]


def _held(base: FramePlan, parts: Ints, triangles: Ints, size: tuple[int, int]) -> FramePlan:
    """The plan that sorts these parts by pixel, and draws no object there that lies in one.

    Parts are widened about objects of many triangles: to draw those twice would cost more.
    """
    if "held" in base.without or not len(parts):
        return replace(base, exact=parts)
    boxes = base.boxes.extents[base.opaque]
    low = np.clip(np.floor(boxes[:, :2]) - 1, 0, size)
    high = np.clip(np.ceil(boxes[:, 2:]) + 1, 0, size)
    boxes = np.concatenate([low, high], axis=1)
    wider = order.merge(order.hold(parts.astype(float), boxes, triangles[base.opaque], SORTED))
    parts = wider.astype(np.int64)
    inside = (parts[:, None, :2] <= low).all(axis=2) & (parts[:, None, 2:] >= high).all(axis=2)
    held = inside.any(axis=0)
    return replace(
        base,
        exact=parts,
        opaque=base.opaque[~held],
        held=base.opaque[held],
    )


def _parts(
    reach: Floats,
    technique: DynamicTransparency,
    size: tuple[int, int],
    without: Set[str],
) -> Ints:
    """What to sort by pixel: the reach of the masks, or all where whole objects turn clear."""
    if technique.granularity != "pixel" or "parts" in without:
        return np.array([[0, 0, *size]])
    return merged_parts(reach, size)
