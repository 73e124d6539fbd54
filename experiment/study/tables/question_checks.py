"""What no question of a study can know alone: which factors there are, what is asked before it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from seethrough.experiment.study.design.factors import WITHIN, Cell, Factor
from seethrough.experiment.study.tables.cells import Part
from seethrough.experiment.study.tables.parameter_tables import Fault
from seethrough.experiment.study.tables.question_items import (
    unfit_names,
    unfit_parameters,
    unmet,
)
from seethrough.experiment.study.tables.question_table import MOMENTS
from seethrough.experiment.study.tables.reading import Question
from seethrough.renderer.meant import one_of

Questions = Mapping[str, Question]


def unfit_questions(
    factors: Sequence[Factor], base: Questions, parts: Mapping[Cell, Part]
) -> list[Fault]:
    """What is wrong with the questions of the base or of any cell, each fault once."""
    found: dict[str, Fault] = {}
    for questions in [base, *{id(p.questions): p.questions for p in parts.values()}.values()]:
        for fault in _unfit(factors, questions):
            found.setdefault(fault.key + str(fault.value), fault)
    return list(found.values())


def _unfit(factors: Sequence[Factor], questions: Questions) -> Iterator[Fault]:
    names = tuple(f.name for f in factors)
    asked = {n: q for n, q in questions.items() if not q.table.off}
    items = {n: items_of(factors, n, q) for n, q in asked.items()}
    yield from unfit_names(factors, items)
    for name, question in asked.items():
        yield from unfit_parameters(name, question, items[name])
    for name, question in questions.items():
        table, where = question.table, f"questions.{name}"
        said = {"each": table.each or (), "only": table.only, "of": (table.of,) * bool(table.of)}
        for key, own in said.items():
            yield from (Fault(f"{where}.{key}", n, one_of(n, names)) for n in own if n not in names)
        for own, levels in table.only.items():
            factor = next((f for f in factors if f.name == own), None)
            for level in (levels,) if isinstance(levels, str) else levels:
                if factor is not None and level not in factor.names:
                    yield Fault(f"{where}.only.{own}", level, one_of(level, factor.names))
        yield from _asked_for_each(factors, where, question)
        yield from _given(factors, name, questions)


def _asked_for_each(factors: Sequence[Factor], where: str, question: Question) -> Iterator[Fault]:
    """Answers say levels that one person meets, and of mixed factors after single trials only."""
    between = question.when_asked in ("task_set", "condition")
    for factor in factors:
        if factor.name not in (question.table.each or ()):
            continue
        if factor.kind != WITHIN:
            said = "factors of which each person meets every level"
            yield Fault(f"{where}.each", factor.name, said)
        elif factor.mixed and between:
            said = f'when = "trial" or "end" beside {factor.name}, which changes within blocks'
            yield Fault(f"{where}.each", factor.name, said)


def _given(factors: Sequence[Factor], name: str, questions: Questions) -> Iterator[Fault]:
    """An item has to be asked before who depends on it: so nothing goes round in circles."""
    own = questions[name]
    order = {n: (MOMENTS.index(q.when_asked), at) for at, (n, q) in enumerate(questions.items())}
    for item in own.table.given:
        key = f"questions.{name}.given"
        asks = [n for n, q in questions.items() if item in items_of(factors, n, q)]
        if not asks:
            every = [i for n, q in questions.items() if n != name for i in items_of(factors, n, q)]
            said = f"an item of a question before {name}"
            known = tuple(dict.fromkeys(every))
            yield Fault(f"{key}.{item}", own.table.given[item], said, known)
        elif not any(order[n] < order[name] for n in asks):
            which = "itself" if asks[0] == name else f"{asks[0]}, which comes later"
            said = f"an item of a question before {name}: {item} is asked by {which}"
            yield Fault(f"{key}.{item}", own.table.given[item], said)
        elif own.table.order and any(_together(n, name, questions) for n in asks):
            said = f"no question that is shuffled with {asks[0]}, on which it depends"
            yield Fault(f"{key}.{item}", own.table.given[item], said)
        else:
            yield from unmet(name, item, own.table.given[item], {n: questions[n] for n in asks})


def _together(one: str, other: str, questions: Questions) -> bool:
    """Whether two questions may come in either order."""
    a, b = questions[one], questions[other]
    return bool(a.table.order and b.table.order and a.when_asked == b.when_asked)


def items_of(factors: Sequence[Factor], name: str, asked: Question) -> tuple[str, ...]:
    """The items that a question may write; of levels that are compared, each one's."""
    from seethrough.experiment.study.tables.ready import question  # pages: not for --help

    items = list(question(asked.use).items(asked.parameters, name))
    compared = next((f for f in factors if f.name == asked.table.of), None)
    if compared is None and asked.use == "comparison":
        compared = next((f for f in factors if f.block), None)
    if compared is not None:
        items += [f"{name}_{n}" for n in range(1, len(compared.names) + 1)]
    return tuple(items)
