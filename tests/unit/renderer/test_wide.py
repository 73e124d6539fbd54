"""Which things are drawn opaque beside the masks: pixels counted one by one."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.plan.frame_plan import BLENDED
from seethrough.renderer.plan.outside import WORTH
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

SIZE, FINE = (400, 300), 3  # each pixel in three by three


def world(seed):
    """Panels and balls of every size before a target or two."""
    rng = np.random.default_rng(seed)
    things = []
    for k in range(24):
        wide, high = rng.uniform(0.3, 9, 2)
        made = geometry.box(wide, high, 0.1) if k % 3 else geometry.sphere(wide / 2, k % 4)
        x, y, z = rng.uniform((-6, -5, 0), (6, 5, 5))
        things.append(Object(made, transforms.translation(x, y, z)))
    for _ in range(1 + seed % 3):
        x, y = rng.uniform(-1.5, 1.5, 2)
        things.append(
            Object(geometry.sphere(0.5, 2), transforms.translation(x, y, -4), target=True)
        )
    camera = look_at(np.array([0.0, 0.0, 14.0]), np.zeros(3), fov_y=0.8, near=1, far=60)
    return Scene(tuple(things)), camera


def counted(seed):
    """(pixels, what the thing has to be worth, whether it is wide) of each blended thing."""
    scene, camera = world(seed)
    frame = plan(scene, camera, DynamicTransparency(), SIZE)
    if not len(frame.holes):
        return
    x, y = (np.indices((SIZE[0] * FINE, SIZE[1] * FINE)) + 0.5) / FINE
    low, high = frame.holes[:, :2].min(axis=0), frame.holes[:, 2:].max(axis=0)
    masks = (x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1])
    for i in np.setdiff1d(np.flatnonzero(frame.reasons == BLENDED), frame.single):
        left, top, right, bottom = frame.boxes.extents[i]
        covered = (x > left) & (x < right) & (y > top) & (y < bottom) & ~masks
        worth = WORTH * len(scene.objects[i].mesh.triangles)
        yield covered.sum() / FINE**2, worth, i in frame.wide


def test_wide_things_cover_so_many_pixels_outside_all_masks_a_triangle():
    """A cell of the grid is a ninth of a pixel: what a border can be off by leaves it open."""
    border = 2 * (SIZE[0] + SIZE[1]) / FINE
    found = [row for seed in range(8) for row in counted(seed)]
    clear = [row for row in found if abs(row[0] - row[1]) > border]
    assert all(wide == (pixels > worth) for pixels, worth, wide in clear)
    assert min(sum(w for *_, w in clear), sum(not w for *_, w in clear)) >= 10
