"""A prediction that a level is not worse than the baseline, in each of several measures."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from seethrough.analysis.comparison import decisive
from seethrough.analysis.design import Design, Prediction
from seethrough.analysis.page.blocks import Cited, Table, say
from seethrough.analysis.sections.answers.answers import Answer, p_runs
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.stats.undefined import Number, either_in, is_defined, number_in
from seethrough.analysis.tradeoff import price_of

ACCURACY = (
    "less accurate",
    "less accurate, though by less than the margin",
    "more accurate",
    "no worse within the margin",
    "not shown to be no worse",
    "without a margin and so untested, no difference being shown",
)
"""What can be said of a measure of accuracy, worst first."""


def accurate(
    context: Context, prediction: Prediction, tables: Mapping[str, Mapping[str, Table]], start: str
) -> Answer:
    """Non-inferiority in every measure, so that the largest p decides and none is corrected."""
    alpha, design = context.plan.alpha, context.design
    parts: dict[str, list[str | Cited]] = {words: [] for words in ACCURACY}
    decides: list[Number] = []
    for measure in (m for m in design.measures() if prediction.about(m)):
        for table in _tables(tables.get(measure.name, {})):
            for row in table.rows:
                if not _is_asked(design, prediction, row):
                    continue
                words, column = verdict_of(design, row, alpha)
                if words:
                    runs = parts[words]
                    name = f"{measure.said}, {row['label']}"
                    runs += ["; " if runs else "", name, *p_runs(table, row, column)]
                    decides.append(either_in(row, "noninferior_p"))
    told = {words: runs for words, runs in parts.items() if runs}
    if not told:
        said = say(f"{start}not answered, no accuracy measure can be tested.", kind="answer")
        return Answer(prediction, said, "not answered")
    verdict = _verdict_of_accuracy(told)
    runs = [f"{start}{verdict}. It is "]
    for i, (words, own) in enumerate(told.items()):
        runs += [". It is " if i else "", f"{words} in ", *own]
    said = say(f"{{}}. {_declared(design, prediction)}", runs, kind="answer")
    known = [p for p in decides if is_defined(p)]
    largest = max(known) if known and len(known) == len(decides) else None
    return Answer(prediction, said, verdict, largest, len(decides))


def _tables(own: Mapping[str, Table]) -> list[Table]:
    """Where a measure's contrasts are."""
    kinds = ("logs", "tests", "ranks", "contrasts")
    found = [own[kind] for kind in kinds if kind in own]
    return found[:1]


def _is_asked(design: Design, prediction: Prediction, row: Mapping[str, object]) -> bool:
    """Whether a row is of the prediction's contrast; other rows are of trends and the like."""
    key = row.get("level") or str(row.get("contrast", "")).partition("/")[2]
    known = [c for c in design.contrasts() if c.factor == prediction.contrast]
    return any(c.key == key and prediction.level in ("", c.level) for c in known)


def _verdict_of_accuracy(told: Collection[str]) -> str:
    if "less accurate" in told:
        return "contradicted"
    if ACCURACY[5] in told:
        return "not answered, for want of a margin declared before the data"
    return "not shown everywhere" if ACCURACY[4] in told else "supported"


def _declared(design: Design, prediction: Prediction) -> str:
    """The margins that accuracy is judged by."""
    own = [f"{m.said} {m.margin:g}" for m in design.measures()
           if prediction.about(m) and m.margin is not None]  # fmt: skip
    if not own:
        return "The study declared no margin of accuracy."
    return (
        f"Margins, declared before the data: {', '.join(own)}. It must be no worse in every "
        "measure, so the largest p decides."
    )


def verdict_of(design: Design, row: Mapping[str, object], alpha: float) -> tuple[str, str]:
    """What a row says of accuracy, and the column of the p behind it; "" where nothing can be.

    A measure that everybody has alike says nothing here. A right-or-wrong one is read in the tasks
    that have no finer: the others are judged by how far off their answers are.
    """
    measure = next((m for m in design.measures() if m.name == row.get("of")), None)
    column, p = decisive(row)
    if not is_defined(p):
        return "", ""
    if measure is not None and measure.ranked:
        task = design.task(str(row.get("where")))
        price = price_of(task) if task is not None else None
        if price is not None and price.name != measure.name:
            return "", ""
    more = measure is not None and measure.direction == "more"
    difference = number_in(row, "difference" if "difference" in row else "estimate")
    no_worse = row["noninferior_p"]
    within = is_defined(no_worse) and no_worse < alpha
    if p < alpha and (difference < 0) == more:
        return "more accurate", column
    if p < alpha:
        return (ACCURACY[1], "noninferior_p") if within else ("less accurate", column)
    if not is_defined(no_worse):
        return ACCURACY[5], column
    return (ACCURACY[3] if within else ACCURACY[4]), "noninferior_p"
