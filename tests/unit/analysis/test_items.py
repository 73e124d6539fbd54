"""Answers that were given a second time, since their trial was played again."""

import numpy as np
import pandas as pd

from seethrough.analysis.load.study import _last_asked


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
