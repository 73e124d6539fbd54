"""The published study's design, as its sidecars have it."""

from seethrough.experiment.record.columns import with_factors
from seethrough.experiment.study.config import load
from seethrough.experiment.study.shown.described import design_entry


def published():
    """The sidecars' `design` entry."""
    return design_entry(load("published"))


def columns():
    """Every table's columns in the published study."""
    return with_factors(published()["factors"], published()["tasks"])
