"""Items of a questionnaire: those that speak against the others, and those asked a second time."""

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Item
from seethrough.analysis.load.study import _last_asked
from seethrough.analysis.measures import all_one_way


def test_items_that_speak_against_the_others_are_turned_round_on_their_own_scale():
    """Of 1 to 7, 7 becomes 1; of −3 to 3, 2 becomes −2; what has no scale stays."""
    values = np.array([[[5.0, 6.0], [7.0, 1.0], [2.0, -3.0], [9.0, 9.0]]])
    cells = Cells(values, np.ones_like(values, dtype=np.intp), ("P01",),
                  {"item": ("for", "against", "signed", "free"), "view": ("a", "b")})  # fmt: skip
    items = (
        Item("against", "", points=7, low=1, against=True),
        Item("signed", "", points=7, low=-3, against=True),
        Item("for", "", points=7, low=1),
        Item("free", "", against=True),
    )
    turned = all_one_way(cells, items)
    assert turned.values.tolist() == [[[5.0, 6.0], [1.0, 7.0], [-2.0, 3.0], [9.0, 9.0]]]
    assert cells.values is not turned.values and cells.values[0, 1, 0] == 7.0


def test_of_what_was_asked_again_after_a_trial_played_again_the_last_counts():
    """The same item about the same trial, in a second session; what was asked at the end stays."""
    table = pd.DataFrame(
        {
            "row_id": list("abcde"),
            "participant": ["P01"] * 4 + ["P02"],
            "session": [1, 1, 2, 2, 1],
            "item": ["hard", "hard", "hard", "remarks", "hard"],
            "after_trial": [1.0, 2.0, 2.0, np.nan, 2.0],
            "value": [3.0, 4.0, 5.0, np.nan, 1.0],
            "text": [""] * 5,
        }
    )
    columns = dict.fromkeys(table.columns, "text")
    kept = _last_asked(table, columns)
    assert kept["row_id"].tolist() == ["a", "c", "d", "e"]
    before = table.drop(columns="after_trial")
    assert _last_asked(before, columns) is before
