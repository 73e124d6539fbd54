"""R's values for the report's tables, and how a cell of ours is held to one of them.

A cell that R gives no value for must be in `WITHOUT`, with the reason: a new column or table that
nobody gave an oracle fails the test.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from seethrough.analysis.page.blocks import Table
from seethrough.analysis.page.tables_csv import as_csv
from seethrough.analysis.stats.distributions import t_two_sided

FOLDER = Path(__file__).parents[1] / "oracles"
DESIGN_FOLDER = FOLDER / "designs"
ABOUT = "made.json"

CLOSED = 1e-8
"""Eight digits of what has a closed form, the tails and their inversions included."""
ITERATIVE = 1e-4
"""Of the standard error: what an iterative fit's estimates may differ by."""
SHAPIRO = 1e-7
"""Of Shapiro's p: scipy's weights come from normal quantiles of seven digits (AS 241, PPND7). W
agrees to nine digits with R's, p, which looks at log(1 − W), to seven."""
FLOORS = {
    "shapiro_p": 1e-12,  # of three values: the difference of two arcsines
    "nemenyi_p": 1e-12,  # one less an integral near one
    "ges": 1e-15,  # a share whose parts cancel where conditions are identical
    "ss_effect": 1e-24,  # squares of the rounding of some hundred seconds
    "ss_error": 1e-24,
}
"""What may be left of a number that is small because larger ones cancel in it."""
CANCEL = 1e-14
"""Of means and s.d.: what rounding leaves of differences between equal sums in another order."""
CANCELLING = ("difference", "within_half", "mean_baseline", "mean_level")
OMEGA = 1e-6
"""Two optimisers of one likelihood, flat near its top."""
NEAR_1E9 = {"log": 1e-5, "": 1e-6}
"""Times near 10⁹: of a spread of some seconds seven digits are left in a mean, which is a double;
their logarithms near 20.7 spread by some 10⁻⁸, and have six to seven."""
SAMPLED = 4.0
"""Monte-Carlo standard errors: 1 in 16,000, and the seeds are fixed."""

WORDS = "words of ours, no number"
WITHOUT: Mapping[tuple[str, str], str] = {
    ("ran", "*"): "versions, hashes, seeds and words",
    ("dictionary", "*"): "words, no number",
    ("flow", "*"): "counts of rows, held by tests/unit/analysis/test_methods.py",
    ("predictions", "*"): "each p that decides stands in another table, too, and is held there",
    ("*", "label"): WORDS,
    ("*", "unit"): WORDS,
    ("*", "task"): "the label of the key's task",
    ("*", "transparency"): "part of the key",
    ("*", "third"): "part of the key",
    ("tradeoff", "error"): WORDS,
    ("difficulty", "quantity"): "the label of the key's quantity",
    ("difficulty", "contrast"): WORDS,
    ("excluded", "why"): WORDS,
    ("files", "sha256"): "a hash, held by the tests of the chain",
    ("files", "chain"): "how far the chain was verified, held by the tests of the chain",
    ("missing", "where"): "part of the key",
    ("missing", "participant"): "part of the key",
    ("*", "method"): "words; what it says of p decides how p is held",
    ("*", "question"): WORDS,
    ("equivalence", "how"): WORDS,
}
"""(table, column) without a counterpart in R, and why; `*` is every one."""


def _fitted(row: Mapping[str, str], times: float = 1.0) -> float:
    return ITERATIVE * times * float(row["error"])


def _p_room(row: Mapping[str, str]) -> float:
    """By how much p changes where both estimate and standard error are off by what they may."""
    t, df = abs(float(row["t"])), float(row["df"])
    least = max(0.0, t - ITERATIVE * (1 + t))
    return t_two_sided(least, df) - t_two_sided(t, df)


FITTED: Mapping[str, Callable[[Mapping[str, str]], float]] = {
    "estimate": _fitted,
    "error": _fitted,
    "t": lambda row: ITERATIVE * (1 + abs(float(row["t"]))),
    "p": _p_room,
    # the ends lie a few standard errors from the estimate, and both move them
    "ratio": lambda row: _fitted(row) * float(row["ratio"]),
    "low": lambda row: _fitted(row, 6) * float(row["low"]),
    "high": lambda row: _fitted(row, 6) * float(row["high"]),
    # its own standard error is about that of the estimate, or larger
    "sd_slope": _fitted,
    "sd_task_slope": _fitted,
    "sd_scene": _fitted,
}
"""Columns of an iterative fit, and what R's row allows."""

NUMBERS = (("consistency", "detail"), ("inconsistent", "detail"))
"""Sentences of which the numbers are held, in order, to the digits that they show."""
EXAMPLES = ("grim_preference", "grim_depth_test", "grim_depth_self_report")
"""Their sentence gives an example of answers, and there are several: its moments are held."""


def has_none(table: str, column: str) -> bool:
    """Whether a column is known to have no counterpart."""
    return any(key in WITHOUT for key in ((table, "*"), ("*", column), (table, column)))


@dataclass(frozen=True)
class Rows:
    """A CSV: its columns, and its rows by the first column."""

    columns: tuple[str, ...]
    rows: Mapping[str, Mapping[str, str]]


def _read(text: str) -> Rows:
    reader = csv.DictReader(io.StringIO(text, newline=""))
    columns = tuple(reader.fieldnames or ())
    rows = list(reader)
    by_key = {row[columns[0]]: row for row in rows}
    assert len(by_key) == len(rows), f"two rows of one key: {columns[0]}"
    return Rows(columns, by_key)


def stored(case: str) -> dict[str, Rows]:
    """R's tables for a folder."""
    files = sorted((FOLDER / case).glob("*.csv"))
    return {path.stem: _read(path.read_text(encoding="utf-8")) for path in files}


def about() -> dict[str, Any]:
    """Versions that made the values, and the hash of each folder that they are of."""
    return json.loads((FOLDER / ABOUT).read_text(encoding="utf-8"))


def closed_form(case: str, table: str) -> float:
    """How close, relatively, a closed form of this folder's table has to be."""
    if case != "offset":
        return CLOSED
    logs = table.endswith("_log") or table in (
        "tests_log_time",
        "order",
        "learning",
        "tradeoff",
        "robust",
    )
    return NEAR_1E9["log" if logs else ""]


def differences(ours: list[Table], case: str) -> list[str]:
    """Every cell that is not R's, and every table, column or row that only one of the two has."""
    theirs = stored(case)
    mine = {table.key: _read(as_csv(table)) for table in ours if (table.key, "*") not in WITHOUT}
    found = [f"{key}: only in one of the two" for key in sorted(mine.keys() ^ theirs.keys())]
    for key in sorted(mine.keys() & theirs.keys()):
        found += _of_table(key, mine[key], theirs[key], closed_form(case, key))
    return found


def _of_table(key: str, mine: Rows, theirs: Rows, closed: float) -> Iterator[str]:
    wanted = {c for c in mine.columns[1:] if not has_none(key, c)}
    given = {c for c in theirs.columns[1:] if not has_none(key, c)}
    yield from (f"{key}.{c}: ours has no value in R, nor a reason" for c in sorted(wanted - given))
    yield from (f"{key}.{c}: only R has it" for c in sorted(given - wanted))
    for column in (c for c in mine.columns[1:] if c not in wanted):
        if any(_is_number(row[column]) for row in mine.rows.values()):
            yield f"{key}.{column}: a number, though it was said to hold none"
    if list(mine.rows) != list(theirs.rows):
        yield f"{key}: rows {list(mine.rows)}, in R {list(theirs.rows)}"
    for row in [r for r in mine.rows if r in theirs.rows]:
        for column in [c for c in mine.columns[1:] if c in wanted & given]:
            why = _of_cell(key, column, mine.rows[row], theirs.rows[row], closed)
            if why:
                yield f"{key} / {row} / {column}: {why}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _of_cell(
    table: str, column: str, mine: Mapping[str, str], theirs: Mapping[str, str], closed: float
) -> str:
    """Why a cell is not R's; empty if it is."""
    ours, wanted = mine[column], theirs[column]
    if (table, column) in NUMBERS:
        same = next(iter(mine.values())) in EXAMPLES or numbers(ours) == numbers(wanted)
        return "" if same else f"{ours!r}, in R {wanted!r}"
    if wanted == "undefined":
        return "" if ours.startswith("undefined: ") else f"{ours}, in R undefined"
    try:
        value, truth = float(ours), float(wanted)
    except ValueError:
        return "" if ours == wanted else f"{ours!r}, in R {wanted!r}"
    room = _room(table, column, truth, mine, theirs, closed)
    return "" if abs(value - truth) <= room else f"{ours}, in R {wanted} ± {room:.2g}"


def numbers(text: str) -> list[float]:
    """The numbers of a sentence; not the 1 of T1."""
    return [float(n) for n in re.findall(r"(?<![A-Za-z\d.])\d*\.?\d+", text)]


def _room(
    table: str,
    column: str,
    truth: float,
    mine: Mapping[str, str],
    theirs: Mapping[str, str],
    closed: float,
) -> float:
    """How far a number may be from R's."""
    if column == "p_flip" and mine.get("method", "").endswith(" draws"):
        draws = int(mine["method"].split()[0])
        # R drew, too, twenty times as many
        return SAMPLED * math.sqrt(truth * (1 - truth) * 1.05 / draws) + 1 / draws
    if column == "p_exact" and mine.get("method", "").endswith(" permutations"):
        draws = int(mine["method"].split()[0])
        # both count the observed order in: (hits + 1) / (draws + 1)
        return SAMPLED * math.sqrt(truth * (1 - truth) / draws) + 1 / draws
    if table == "reliability" and column == "omega":
        return OMEGA
    if table in ("mixed_model", "mixed_scenes") and column in FITTED:
        return FITTED[column](theirs) + CLOSED * abs(truth)
    floor = FLOORS.get(column, 0.0)
    if column in CANCELLING and "sd_baseline" in theirs:
        sizes = ("mean_baseline", "mean_level", "sd_baseline", "sd_level")
        floor = CANCEL * sum(abs(float(theirs[c])) for c in sizes if theirs[c] != "undefined")
    return max(closed, SHAPIRO if column == "shapiro_p" else 0.0) * abs(truth) + floor
