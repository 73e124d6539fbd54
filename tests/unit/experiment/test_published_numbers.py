"""The paper's numbers are the same wherever they are used: the file that has them as printed."""

import tomllib
from importlib import resources

import pytest

from seethrough.experiment.power import power

FILE = resources.files("seethrough.analysis.published").joinpath("published.toml")
PRINTED = {m["name"]: m for m in tomllib.loads(FILE.read_text("utf-8"))["measure"]}


def numbers(name):
    m = PRINTED[name]
    texts = (m["standard"]["mean"], m["standard"]["sd"], m["dynamic"]["mean"], m["dynamic"]["sd"])
    return tuple(float(text) for text in (*texts, m["F"]))


OF_POWER = {
    "time, overall": "time_overall",
    "time T1 count": "time_T1",
    "time T2 pattern": "time_T2",
    "time T3 unique": "time_T3",
    "time T4 count in building": "time_T4",
    "relative error T1": "error_T1",
    "relative error T4": "error_T4",
    "distance T3": "distance_T3",
}


@pytest.mark.parametrize("row", power.PUBLISHED, ids=lambda row: row[0])
def test_power_plans_with_what_was_printed(row):
    assert row[1:] == numbers(OF_POWER[row[0]])


def test_power_plans_for_every_measure():
    assert [row[0] for row in power.PUBLISHED] == list(OF_POWER)
