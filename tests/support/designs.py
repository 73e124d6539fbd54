"""Random designs for property tests: 1–4 factors of 2–6 levels, groups, cells left out."""

from hypothesis import strategies as st

from seethrough.experiment.study.design.balance import Met
from seethrough.experiment.study.design.design import CellPlan, Design, session_for
from seethrough.experiment.study.design.factors import (
    BETWEEN,
    MEASURED,
    WITHIN,
    Factor,
    Level,
    every_cell,
    left_out,
)
from seethrough.experiment.study.design.squares import MIXED, SQUARES

MOST_CELLS = 36  # of a design: its complete cycle is played


@st.composite
def designs(draw, orders=("williams", "latin", "fixed", "random")):
    """A design whose cells are all there, or but for a few."""
    factors, cells = [], 1
    for number in range(draw(st.integers(1, 4))):
        levels = draw(st.integers(2, 6))
        if cells * levels > MOST_CELLS:
            break
        cells *= levels
        kind = draw(st.sampled_from((WITHIN, WITHIN, WITHIN, BETWEEN, MEASURED)))
        order = draw(st.sampled_from(("", "", *SQUARES, MIXED))) if kind == WITHIN else ""
        scenes = draw(st.sampled_from(("alone", "changed")))
        names = tuple(Level(f"{'abcd'[number]}{k}") for k in range(levels))
        factors.append(Factor(f"f{number}", names, kind, order, scenes=scenes))
    every = every_cell(factors)
    excluded = []
    if len(factors) > 1 and draw(st.booleans()):
        cell = draw(st.sampled_from(every))
        excluded = [{f.name: level for f, level in zip(factors, cell, strict=True)}]
    groups = 1
    for factor in factors:
        groups *= len(factor.levels) if factor.kind != WITHIN else 1
    tasks = tuple(f"task{k}" for k in range(draw(st.integers(1, 3))))
    shared = draw(st.booleans())
    plan = CellPlan("world", tasks, draw(st.integers(1, 2)), draw(st.integers(0, 2)), shared)
    there = [
        c
        for c in every
        if not left_out(dict(zip([f.name for f in factors], c, strict=True)), excluded)
    ]
    return Design(
        tuple(factors),
        dict.fromkeys(there, plan),
        draw(st.sampled_from(orders)),
        draw(st.integers(groups, 96)),
        draw(st.integers(0, 99)),
        tuple(excluded),
    )


def played(design, slots):
    """Every trial of these slots' sessions, as their tables have them."""
    return [
        Met(slot, t.block, t.levels, t.task, t.scene)
        for slot in slots
        for task_set in session_for(slot, design)
        for t in task_set.trials
    ]
