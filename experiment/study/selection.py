"""Which scenes a study selects, and by which rule: declared in its file, held to by
`power --scenes`, and told by every record, so that the report says that scenes were selected."""

from __future__ import annotations

from collections.abc import Iterator

from seethrough.experiment.errors import shown
from seethrough.experiment.study.design.factors import ALONE
from seethrough.experiment.study.study import Study
from seethrough.renderer.meant import one_of

WHERE = "design.select"


def unfit_selection(study: Study) -> Iterator[str]:
    """A line for each fault of the rule: one that names no factor, or says nothing."""
    select = study.design.select
    if select is None:
        return
    known = [f.name for f in study.factors if f.scenes == ALONE and len(f.names) > 1]
    if not select.factor and not select.rule:
        yield f"{WHERE}: expected `factor` and `least`, or a `rule` in words"
    if select.factor and select.factor not in known:
        yield (
            f"{WHERE}.factor = {shown(select.factor)}: expected a factor that leaves scenes alone: "
            f"{one_of(select.factor, known) if known else 'the study has none'}"
        )
    if bool(select.factor) != (select.least is not None):
        lacks = "least" if select.factor else "factor"
        yield f"{WHERE}.{lacks}: expected with the other of `factor` and `least`"


def said(study: Study) -> str:
    """The rule in words, with how many scenes were drawn again; "" where none is declared."""
    select = study.design.select
    if select is None:
        return ""
    rules = [select.rule.strip().rstrip(".")] if select.rule.strip() else []
    if select.factor and select.least is not None:
        rules.append(
            f"only scenes in which the levels of {select.factor} are at least {select.least:g} "
            "apart in the share that they show of what is asked for"
        )
    again = len(set(study.design.redraw))
    drawn = f"{again} scene{'s were' if again != 1 else ' was'} drawn again" if again else ""
    return "; ".join([*rules, *([drawn] if drawn else [])])
