"""Predictions of single answers, and of any measure by any contrast."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from seethrough.analysis.design import Contrast, Measured, Prediction
from seethrough.analysis.page.blocks import Cited, Table, say
from seethrough.analysis.page.numbers import equals, p_value
from seethrough.analysis.sections.answers.answers import Answer, depends, on_average, rows_of
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.distributions import t_upper
from seethrough.analysis.stats.multiplicity import holm
from seethrough.analysis.stats.undefined import Number, either_in, is_defined, number_in


def at_least(
    context: Context, prediction: Prediction, single: Table | None, start: str
) -> Answer:  # fmt: skip
    """What was asked once, against the value that it was to reach."""
    item = next(iter(prediction.measures), "")
    rows = {str(r["item"]) for r in single.rows} if single else set()
    if single is None or item not in rows:
        return Answer(prediction, say(f"{start}not asked.", kind="answer"), "not asked")
    row, mean, n = single.row(item), single.cite(item, "mean"), single.cite(item, "n")
    if prediction.value is None or not is_defined(row["sd"]) or row["sd"] == 0:
        why = "no value to reach was stated" if prediction.value is None else "nobody differs"
        said = say(
            f"{start}not testable. {{}} on average (n = {{}}); {why}, so this describes and does "
            "not test.",
            mean,
            n,
            kind="answer",
        )
        return Answer(prediction, said, "not testable")
    t = (number_in(row, "mean") - prediction.value) / (
        number_in(row, "sd") / number_in(row, "n") ** 0.5
    )
    p = t_upper(t, number_in(row, "n") - 1)
    verdict = "supported" if p < context.plan.alpha else "not shown"
    shown = p_value(p)
    said = say(
        f"{start}{verdict}. {{}} on average (n = {{}}), {prediction.value:g} was "
        f"to be reached (one-sided p {equals(shown)}{shown}).",
        mean,
        n,
        kind="answer",
    )
    return Answer(prediction, said, verdict, p, 1)


def compared(
    context: Context, prediction: Prediction, tables: Mapping[str, Mapping[str, Table]],
    contrasts: Sequence[Contrast], start: str,
) -> Answer:  # fmt: skip
    """Less, more, different or equivalent: every measure's tests of every contrast asked."""
    alpha = context.plan.alpha
    tests: list[tuple[str, Table, Mapping[str, object], Number, bool]] = []
    for measure in (m for m in context.design.measures() if prediction.about(m)):
        for contrast in contrasts:
            found = rows_of(tables.get(measure.name, {}), contrast)
            pooled = [x for x in found if _is_overall(x[1])]
            for table, row in pooled or found:
                column = "tost_p" if prediction.expect == "equivalent" else _raw(row)
                fits = _fits(measure, row, prediction.expect)
                tests.append((column, table, row, either_in(row, column), fits))
    if not tests:
        said = say(f"{start}not answered, nobody has what it needs.", kind="answer")
        return Answer(prediction, said, "not answered")
    known = [p for *_, p, _ in tests if is_defined(p)]
    if len(known) < len(tests):
        said = say(f"{start}not answered: a test of it is undefined.", kind="answer")
        return Answer(prediction, said, "not answered", None, len(tests))
    several = prediction.combine == "any"
    used = holm(known).tolist() if several else known
    shown = [p < alpha for p in used]
    fitting = [fit for *_, fit in tests]
    reached = [s and f for s, f in zip(shown, fitting, strict=True)]
    supported = any(reached) if several else all(reached)
    against = any(s and not f for s, f in zip(shown, fitting, strict=True))
    verdict = "supported" if supported else "contradicted" if against else "not shown"
    unlike = [run for m in context.design.measures() if prediction.about(m)
              for run in depends(tables.get(m.name, {}), prediction.contrast, alpha)]  # fmt: skip
    verdict = on_average(verdict, bool(unlike))
    runs: list[str | Cited] = [f"{start}{verdict}. "]
    for i, (column, table, row, _, _) in enumerate(tests):
        key = str(row[table.columns[0].name])
        p = table.cite(key, column)
        estimate = "ratio" if row.get("ratio") is not None and "logs" in key else _estimate(row)
        runs += ["; " if i else "", f"{row['label']}: {_named(estimate)} "]
        runs += [table.cite(key, estimate), *_interval(table, key, estimate)]
        runs += [f", p {equals(p.text)}", p]
    decides = min(used) if several else max(used)
    runs.append("." if len(tests) == 1 else f" ({_combined(several, decides)}).")
    runs += unlike
    return Answer(prediction, say("{}", runs, kind="answer"), verdict, decides, len(tests))


def _combined(several: bool, decides: float) -> str:
    if not several:
        return "all are needed, the largest p decides"
    p = p_value(decides)
    corrected = f"the least by Holm's correction is p {equals(p)}{p}"
    return f"one is enough; these p are uncorrected, {corrected}"


def _is_overall(row: Mapping[str, object]) -> bool:
    return row.get("where") == "overall" or str(row.get("contrast", "")).startswith("overall/")


def _raw(row: Mapping[str, object]) -> str:
    """The uncorrected p that decides: a stated prediction is a family of its own."""
    return "p_exact" if "p_exact" in row else "p"


def _estimate(row: Mapping[str, object]) -> str:
    if "contrast" in row:
        return "ratio" if row.get("ratio") is not None else "estimate"
    return "ratio" if "geometric_level" in row else "difference"


def _interval(table: Table, key: str, estimate: str) -> list[str | Cited]:
    """` [0.75, 1.01]`, where the row has the estimate's interval."""
    ends = ("low", "high") if estimate == "estimate" else (f"{estimate}_low", f"{estimate}_high")
    row = table.row(key)
    if not all(is_defined(row.get(end)) and row.get(end) is not None for end in ends):
        return []
    return [" [", table.cite(key, ends[0]), ", ", table.cite(key, ends[1]), "]"]


def _named(estimate: str) -> str:
    return {"ratio": "ratio", "estimate": "difference"}.get(estimate, estimate)


def _fits(measure: Measured, row: Mapping[str, object], expect: str) -> bool:
    """Whether an estimate lies on the predicted side; differences are baseline − level."""
    if expect in ("different", "equivalent"):
        return True
    difference = number_in(row, "difference" if "difference" in row else "estimate")
    return bool(difference > 0) == (expect == "less")
