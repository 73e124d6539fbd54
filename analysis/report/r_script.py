"""`analysis.R`: the report's tests in R, readable, from the study's own CSV files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from jinja2 import Environment, StrictUndefined

from seethrough.analysis.design import Design, Item
from seethrough.analysis.load.plan import Plan
from seethrough.analysis.page.html import template
from seethrough.analysis.sections.base.asked import Alike
from seethrough.analysis.sections.reliability import parts_of

FILE = "analysis.R"


@dataclass(frozen=True)
class Facts:
    """Choices of a report's that its script has to know: the levels of each factor in the largest
    complete table, the mixed model's random terms and those of the model with scenes ("" for no
    such model), which questions are asked alike, and which go together."""

    omnibus: Mapping[str, Sequence[str]]
    model: str
    scenes: str
    asked: Sequence[Alike]
    scales: Sequence[tuple[str, Sequence[Item]]]


def as_r(title: str, source: str, plan: Plan, design: Design, facts: Facts) -> str:
    """The script of a study."""
    page = Environment(undefined=StrictUndefined, keep_trailing_newline=True).from_string(
        template("analysis.R.j2")
    )
    constants = "\n".join(_constants(source, plan, design, facts))
    return page.render(title=title.replace("\n", " "), constants=constants)


def _constants(source: str, plan: Plan, design: Design, facts: Facts) -> list[str]:
    numbers = {f.name: f.numbers for f in design.factors if f.within and f.numbers is not None}
    main = design.main
    return [
        f"SOURCE <- {_text(source)}",
        f"ALPHA <- {plan.alpha!r}",
        f"TASKS <- {_texts(design.task_names)}",
        "# factors within and between people, with their levels in the study's order",
        f"WITHIN <- {_lists({f.name: f.levels for f in design.factors if f.within})}",
        f"BETWEEN <- {_lists({f.name: f.levels for f in design.groups})}",
        f"MEASURED <- {_texts([f.name for f in design.groups if f.kind == 'measured'])}",
        f"NESTING <- {_texts([f.name for f in design.nesting])}",
        f"BASELINE <- {_lists({f.name: [f.baseline] for f in design.factors})}",
        f"NUMBERS <- {_lists(numbers)}",
        f"EXCLUDED <- {_nested([_lists({k: [v] for k, v in c.items()}) for c in design.excluded])}",
        "# factors of which every pair of levels was asked for",
        f"PAIRWISE <- {_texts(plan.pairwise)}",
        f"ALIGNED <- {_bool(plan.aligned_ranks)}",
        "# the largest table without a cell that the study leaves out",
        f"OMNIBUS <- {_lists(facts.omnibus)}",
        f"MEASURES <- {_nested(_measures(design))}",
        f"MAIN <- {_text(main.name if main else '')}",
        f"MODEL <- {_text(facts.model)}",
        f"SCENES <- {_text(facts.scenes)}",
        f"ASKED <- {_nested([_asked(group) for group in facts.asked])}",
        f"SCALES <- {_nested([_scale(name, items) for name, items in facts.scales])}",
    ]


def _asked(group: Alike) -> str:
    return (
        f"list(name = {_text(group.name)}, stem = {_text(group.stem)}, "
        f"items = {_texts([i.name for i in group.items])}, "
        f"each = {_texts([f.name for f in group.each])}, "
        f"main = {_text(group.each[-1].name)}, both_ways = {_bool(group.both_ways)})"
    )


def _scale(name: str, items: Sequence[Item]) -> str:
    turned = sorted({r for i in items for r in i.reverse})
    return (
        f"list(name = {_text(name)}, items = {_texts(parts_of(items))}, "
        f"each = {_texts(items[0].each)}, reverse = {_texts(turned)})"
    )


def _measures(design: Design) -> list[str]:
    return [
        f"list(name = {_text(m.name)}, column = {_text(m.column)}, scale = {_text(m.scale)}, "
        f"adds = {_text(m.adds)}, log = {_bool(m.log)}, rows = {_text(m.rows)}, "
        f"pool = {_bool(m.pool)}, tasks = {_texts(design.tasks_with(m.name))})"
        for m in design.measures()
    ]


def _text(value: str) -> str:
    """A text as R reads it: the escapes of JSON are R's, too."""
    return json.dumps(value, ensure_ascii=False).replace("\\/", "/")


def _bool(value: bool) -> str:
    return "TRUE" if value else "FALSE"


def _texts(values: Sequence[str | float]) -> str:
    inner = ", ".join(_text(v) if isinstance(v, str) else repr(float(v)) for v in values)
    return f"c({inner})" if values else "character(0)"


def _lists(table: Mapping[str, Sequence[str | float]]) -> str:
    return f"list({', '.join(f'`{k}` = {_texts(list(v))}' for k, v in table.items())})"


def _nested(items: Sequence[str]) -> str:
    return "list(\n  " + ",\n  ".join(items) + "\n)" if items else "list()"
