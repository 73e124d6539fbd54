"""Blocks that an object's triangles can touch, against every pixel that they cover."""

from __future__ import annotations

import numpy as np
import pytest

from seethrough.renderer.plan import blocks, coverage
from seethrough.renderer.plan.blocks import BLOCK
from seethrough.renderer.reference.pixel_fragments import fragments
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.projection import screen_boxes
from seethrough.renderer.scene.scene import Object, Scene

SIZE = (90, 70)  # not whole blocks
EVERYWHERE = np.array([0, 0, *SIZE])


def world(seed, near=False):
    """Tori and boxes strewn about, seen from among them if `near`."""
    rng = np.random.default_rng(seed)
    shapes = (geometry.torus(1.0, 0.2), geometry.box(3, 0.2, 0.2), geometry.sphere(0.6))
    objects = tuple(
        Object(shapes[i % 3], transforms.placed(rng.uniform(-4, 4, 3),
               transforms.random_rotation(rng), rng.uniform(0.5, 1.5)))
        for i in range(12)
    )  # fmt: skip
    eye = rng.uniform(-1, 1, 3) + np.array([0, 0, 0.5 if near else 12.0])
    return Scene(objects), look_at(eye, np.zeros(3), fov_y=0.8, near=0.2, far=60)


def covered(scene, camera, part=EVERYWHERE, numbers=None):
    found = coverage.triangles(scene)
    n = len(scene.objects)
    turns = camera.rotation.T @ scene.transforms[:, :3, :3]
    moves = (scene.centers - camera.eye) @ camera.rotation
    bits = np.zeros(blocks.shape(SIZE), np.uint64)
    numbers = np.arange(n) if numbers is None else numbers
    boxes = screen_boxes(scene.corners, camera, SIZE).extents
    lens = coverage.lens(camera, SIZE)
    spans = found.spans
    coverage.cover(
        *(found.points, found.corners, spans, numbers, turns, moves, lens, boxes, part, bits)
    )
    return bits


def shown(scene, camera):
    """(n, rows, columns) blocks in which the reference finds any of an object."""
    depth = np.isfinite(fragments(scene, camera, SIZE).depth)
    rows, columns = blocks.shape(SIZE)
    padded = np.zeros((len(depth), rows * BLOCK, columns * BLOCK), bool)
    padded[:, : SIZE[1], : SIZE[0]] = depth
    return padded.reshape(len(depth), rows, BLOCK, columns, BLOCK).any(axis=(2, 4))


@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("seed", range(6))
def test_no_block_with_a_pixel_of_an_object_is_missed(seed, near):
    scene, camera = world(seed, near)
    bits = covered(scene, camera)
    for k, truth in enumerate(shown(scene, camera)):
        mine = (bits >> np.uint64(k)) & np.uint64(1) == 1
        assert not (truth & ~mine).any()


def test_fewer_blocks_than_boxes_touch():
    """A thin ring leaves its middle out, a diagonal rod the corners of its box."""
    scene, camera = world(3)
    bits = covered(scene, camera)
    boxes = screen_boxes(scene.corners, camera, SIZE).extents
    by_box = blocks.covered(boxes, np.arange(len(boxes)), bits.shape)
    assert not (bits & ~by_box & ~_beside(by_box)).any()
    count = [sum(int(b).bit_count() for b in x.ravel()) for x in (bits, by_box)]
    assert count[0] < 0.8 * count[1]


def _beside(bits):
    """Bits of the blocks around: a pixel's slack may reach into them."""
    grown = np.zeros_like(bits)
    rows, columns = bits.shape
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            to = slice(max(dy, 0), rows + min(dy, 0)), slice(max(dx, 0), columns + min(dx, 0))
            of = slice(max(-dy, 0), rows + min(-dy, 0)), slice(max(-dx, 0), columns + min(-dx, 0))
            grown[to] |= bits[of]
    return grown


def test_only_a_part_of_the_picture_is_asked_for():
    """What lies beyond it stays as it was; within, nothing changes; objects may share a number."""
    scene, camera = world(1)
    part = np.array([24, 16, 64, 48])
    bits, whole = covered(scene, camera, part), covered(scene, camera)
    inside = np.zeros(bits.shape, bool)
    inside[2:6, 3:8] = True
    np.testing.assert_array_equal(bits, np.where(inside, whole, 0))
    shared = covered(scene, camera, numbers=np.full(len(scene.objects), 63))
    np.testing.assert_array_equal(shared != 0, whole != 0)
    assert set(np.unique(shared).tolist()) <= {0, 1 << 63}
