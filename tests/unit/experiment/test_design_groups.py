"""Cells, conditions and groups of small designs, written out by hand."""

import pytest

from seethrough.experiment.study.design.design import CellPlan, Design
from seethrough.experiment.study.design.factors import (
    BETWEEN,
    MEASURED,
    Factor,
    Level,
    every_cell,
)
from seethrough.experiment.study.design.groups import groups_of, quotas


def factor(name, levels, *more, **named):
    return Factor(name, tuple(Level(level) for level in levels), *more, **named)


A, B = factor("a", "st"), factor("b", "xyz")


@pytest.mark.parametrize(
    ("excluded", "cells"),
    [
        ([], "sx sy sz tx ty tz"),
        ([{"a": "s", "b": "z"}], "sx sy tx ty tz"),
        ([{"b": "y"}], "sx sz tx tz"),
        ([{"a": "s", "b": "x"}, {"a": "t", "b": "z"}], "sy sz tx ty"),
    ],
)
def test_an_entry_leaves_out_the_cells_of_which_all_holds_that_it_says(excluded, cells):
    assert ["".join(cell) for cell in every_cell((A, B), excluded)] == cells.split()


@pytest.mark.parametrize("order", ["", "latin"])
def test_conditions_are_in_the_order_of_the_file_whether_they_cross_or_nest(order):
    factors = (A, factor("b", "xyz", order=order))
    gone = ({"a": "s", "b": "y"},)
    plan = CellPlan("abstract", ("count",), 1, 0)
    design = Design(factors, dict.fromkeys(every_cell(factors, gone), plan), excluded=gone)
    found = [f"{c['a']}{c['b']}" for c in design.conditions()]
    assert found == ["sx", "sz", "tx", "ty", "tz"]


@pytest.mark.parametrize(
    ("people", "levels", "places"), [(7, 3, [3, 2, 2]), (8, 3, [3, 3, 2]), (6, 3, [2, 2, 2])]
)
def test_people_who_do_not_divide_go_to_the_first_levels(people, levels, places):
    group = factor("g", "uvw"[:levels], BETWEEN)
    assert list(quotas([group], [(n,) for n in group.names], people).values()) == places


def test_quotas_that_cross_keep_each_level_s_sum():
    first, second = factor("g", "uv", BETWEEN, people=(2, 6)), factor("h", "xy", BETWEEN)
    keys = every_cell((first, second))
    assert quotas([first, second], keys, 8) == dict(zip(keys, (1, 1, 3, 3), strict=True))


def test_one_wanted_stands_in_the_middle_of_the_others():
    first, second = factor("g", "uvw", BETWEEN), factor("h", "xy", BETWEEN, people=(1, 8))
    found = quotas([first, second], every_cell((first, second)), 9)
    assert [found[g, "x"] for g in "uvw"] == [0, 1, 0]
    assert [found[g, "y"] for g in "uvw"] == [3, 2, 3]


def test_a_group_names_what_is_assigned_and_what_is_brought_along():
    factors = (A, factor("g", "uv", BETWEEN), factor("age", "yo", MEASURED))
    groups = groups_of(factors, every_cell(factors), 8)
    assert [dict(g.levels) for g in groups] == [{"g": g, "age": age} for g in "uv" for age in "yo"]
    assert [dict(g.measured) for g in groups] == [{"age": "y"}, {"age": "o"}] * 2
    assert [g.people for g in groups] == [2, 2, 2, 2]
    assert [g.cells for g in groups] == [
        (("s", g, age), ("t", g, age)) for g in "uv" for age in "yo"
    ]
