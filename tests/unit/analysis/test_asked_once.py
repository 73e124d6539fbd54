"""What is asked once: names are counted, not averaged; a rank has its option's name."""

from __future__ import annotations

import numpy as np
import pytest
from made_designs import Design, factor, make_design

from seethrough.analysis.report import Options, make_report, tables_of

ANSWERS = {  # slot → (again, order of plain and cut, tools)
    1: ("yes", (1, 2), (1, 0)),
    2: ("no", (2, 1), (1, 1)),
    3: ("yes", (1, 2), (0, 0)),
    4: ("yes", (2, 1), (1, 0)),
}


def answers(slot):
    again, ranks, tools = ANSWERS[slot]
    return [
        {"item": "again", "value": ("yes", "no").index(again), "text": again},
        *({"item": f"order_{n}", "value": rank, "text": text}
          for n, (rank, text) in enumerate(zip(ranks, ("plain", "cut"), strict=True), start=1)),
        *({"item": f"tools_{n}", "value": chosen, "text": text}
          for n, (chosen, text) in enumerate(zip(tools, ("mouse", "keys"), strict=True), start=1)),
        {"item": "age", "value": 20 + slot, "text": ""},
    ]  # fmt: skip


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    items = [{"name": n, "label": n.replace("_", " "), "each": [], "group": "", "of": ""}
             for n in ("again", "order_1", "order_2", "tools_1", "tools_2", "age")]  # fmt: skip
    design = Design((factor("view", "plain", "cut"),), (4,), answers=answers, more={"items": items})
    folder = make_design(tmp_path_factory.mktemp("once") / "data", design)
    return {table.key: table for table in tables_of(make_report(folder, Options()))}


def test_what_is_chosen_is_counted(tables):
    found = {r["choice"]: (r["n"], r["chosen"], r["share"]) for r in tables["choices"].rows}
    assert found == {"again/yes": (4, 3, 0.75), "again/no": (4, 1, 0.25)}


def test_numbers_ranks_and_ticks_have_means_and_their_options_names(tables):
    rows = {str(r["item"]): r for r in tables["single_items"].rows}
    assert "again" not in rows
    assert {k: r["label"] for k, r in rows.items()} == {
        "order_1": "order 1: plain", "order_2": "order 2: cut", "tools_1": "tools 1: mouse",
        "tools_2": "tools 2: keys", "age": "age",
    }  # fmt: skip
    assert [rows[k]["mean"] for k in ("order_1", "tools_1", "tools_2")] == [1.5, 0.75, 0.25]
    assert rows["age"]["sd"] == pytest.approx(np.std([21, 22, 23, 24], ddof=1))
