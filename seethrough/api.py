"""What programs outside may rely on: data and results of a study as tables of pandas.

    from seethrough import api

    study = api.load("data/")
    study.counted.groupby(study.factors)["time"].median()
    api.results("data/")["anova_time_log"]

`VERSION` counts changes that a program would notice; what stands here stays, or the number grows.
docs/notebook.md has a worked example.
"""

from __future__ import annotations

from seethrough.analysis.notebook import Loaded, load, results

__all__ = ["VERSION", "Loaded", "load", "results"]

VERSION = 1
