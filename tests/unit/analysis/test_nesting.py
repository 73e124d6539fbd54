"""Tasks that stand in a level of a factor, taken together."""

import numpy as np
import pandas as pd

from seethrough.analysis.cells import Cells
from seethrough.analysis.design import Factor
from seethrough.analysis.measures import by_nesting


def test_each_level_has_the_mean_of_its_own_tasks_and_of_no_others():
    """Three tasks, two in one place and one in the other, two views; one person lacks a cell."""
    values = np.array([
        [[1.0, 2.0], [3.0, 6.0], [10.0, 20.0]],
        [[2.0, 2.0], [np.nan, 4.0], [30.0, 40.0]],
    ])  # fmt: skip
    counts = np.isfinite(values).astype(np.intp) * 3
    factors = {"task": ("count", "find", "walk"), "view": ("plain", "cut")}
    place = Factor("place", "within", ("cloud", "house", "yard"), "cloud")
    trials = pd.DataFrame({"task": ["walk", "count", "find", "count"],
                           "place": ["house", "cloud", "cloud", "cloud"]})  # fmt: skip
    found = by_nesting(Cells(values, counts, ("P1", "P2"), factors), place, trials)
    assert found.factors == {"place": ("cloud", "house"), "view": ("plain", "cut")}
    np.testing.assert_array_equal(
        found.values, [[[2.0, 4.0], [10.0, 20.0]], [[np.nan, 3.0], [30.0, 40.0]]]
    )
    np.testing.assert_array_equal(found.counts, [[[6, 6], [3, 3]], [[3, 6], [3, 3]]])
