"""The mark on the floor plan: moved by keys and clicks, in world units."""

import pytest
from numpy.testing import assert_allclose
from played_tasks import ASPECT

from seethrough.renderer.events import KeyPress, PointerPress
from seethrough.tasks.worlds.building.plan_mark import PlanMark


@pytest.mark.parametrize(
    ("key", "way"), [("left", (-1, 0)), ("right", (1, 0)), ("up", (0, -1)), ("down", (0, 1))]
)
def test_an_arrow_key_moves_the_mark_one_step_of_32_and_never_off_the_plan(key, way):
    plan = PlanMark(ASPECT, 80.0, mark=(3.0, -7.0), hint="hint.outside")
    moved = plan.on_event(KeyPress(1.0, key))
    assert_allclose(moved.mark, (3.0 + way[0] * 2.5, -7.0 + way[1] * 2.5))
    assert moved.hint == "" and not moved.confirmed
    for n in range(40):
        moved = moved.on_event(KeyPress(2.0 + n, key))
    assert_allclose(
        moved.mark, [w * 40.0 if w else old for w, old in zip(way, plan.mark, strict=True)]
    )


def test_a_mark_is_where_it_was_clicked_and_nothing_else_moves_it():
    plan = PlanMark(ASPECT, 80.0)
    assert plan.on_event(KeyPress(1.0, "left")).mark == (0.0, 0.0)
    assert plan.on_event(KeyPress(1.0, "x")) is plan
    r = plan.rect
    for share in ((0.0, 0.0), (1.0, 1.0), (0.25, 0.75)):
        x, y = r.x + share[0] * r.width, r.y + share[1] * r.height
        marked = plan.on_event(PointerPress(1.0, x, y))
        assert_allclose(marked.mark, [80 * (s - 0.5) for s in share], atol=1e-9)
        assert_allclose(marked.on_view(*marked.mark), (x, y))
    beside = plan.on_event(PointerPress(1.0, r.x - 0.01, 0.5))
    assert beside.mark is None and beside.hint == "hint.outside"
    b = plan.button
    early = plan.on_event(PointerPress(1.0, b.x + b.width / 2, b.y + b.height / 2))
    assert early.hint == "hint.mark" and not early.confirmed
    assert b.y > r.y + r.height and b.y + b.height < 1
    assert_allclose(r.x + r.width / 2, ASPECT / 2)
    assert_allclose(b.x + b.width / 2, ASPECT / 2)
