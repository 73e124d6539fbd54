"""Reference values that other programs printed, and the data they printed them for.

tests/data/statistics/oracles.json names tool and version beside each value.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).parents[1] / "data" / "statistics"


def values() -> dict[str, Any]:
    """The whole file of reference values."""
    return json.loads((FOLDER / "oracles.json").read_text())


def rows(name: str) -> list[dict[str, str]]:
    """A data set's rows."""
    with open(FOLDER / f"{name}.csv", newline="") as file:
        return list(csv.DictReader(file))


def array(name: str, factors: list[str], who: str = "id", y: str = "y") -> NDArray[np.float64]:
    """A data set as (participants, levels of each factor), levels in order of appearance."""
    table = rows(name)
    people = list(dict.fromkeys(r[who] for r in table))
    levels = [list(dict.fromkeys(r[f] for r in table)) for f in factors]
    out = np.full((len(people), *(len(known) for known in levels)), np.nan)
    for row in table:
        place = [known.index(row[f]) for known, f in zip(levels, factors, strict=True)]
        out[(people.index(row[who]), *place)] = float(row[y])
    return out
