"""The same question asked of single trials by a mixed model."""

from __future__ import annotations

from seethrough.analysis.design import Factor
from seethrough.analysis.mixed import MODELS, MixedEffect, mixed_model
from seethrough.analysis.page.blocks import Block, Column, Section, Table, say
from seethrough.analysis.sections.base.context import Context
from seethrough.analysis.sections.base.mixed_effects import (
    EFFECT,
    FITTED,
    INTERVAL,
    TESTED,
    cited_ratio,
    key_of,
    shared_values,
)
from seethrough.analysis.sections.robust import robust_blocks
from seethrough.analysis.sections.scene_effects import scene_blocks
from seethrough.analysis.stats.undefined import is_defined, number_in
from seethrough.analysis.tradeoff import speed_of

COLUMNS = (
    EFFECT,
    Column("n", "n", "int"),
    Column("trials", "trials", "int"),
    *TESTED,
    Column("ratio", "ratio", "fixed3", "level / baseline"),
    *INTERVAL,
    Column("sd_slope", "SD of slopes", "fixed3", "between participants"),
    Column("sd_task_slope", "SD of slopes", "fixed3", "between tasks of a participant"),
    *FITTED,
)
SHOWN = tuple("n trials estimate error t df p ratio sd_slope sd_task_slope singular".split())


TITLE = "Does the model matter?"


def sensitivity_section(context: Context, logs: Table | None) -> Section | None:
    """Mixed model beside the contrast scores' answer; None where no factor varies within people."""
    factor = context.design.main
    if factor is None:
        return None
    if speed_of(context.design) is None:
        return Section("sensitivity", TITLE, tuple(robust_blocks(context)))
    fits = mixed_model(context.trials, context.design)
    several = len(fits) > 1
    first = fits[0]
    coding = ", ".join(f.name for f in (*context.design.groups, *context.design.crossed)
                       if f is not factor)  # fmt: skip
    sums = f"tasks{' and ' + coding if coding else ''} sum-coded"
    codes = "−½ and ½" if len(factor.levels) == 2 else f"against {factor.baseline}, centred"
    times = " × " if first.crossed else " + "
    terms = times.join([factor.name, "task", *coding.split(", ")] if coding else
                       [factor.name, "task"])  # fmt: skip
    table = Table(
        "mixed_model",
        "Mixed model of log times, all trials",
        COLUMNS,
        tuple(_row(fit, factor, several) for fit in fits),
        ("effect", *SHOWN) if several else SHOWN,
        note=f"log time ~ {terms} + {first.model or '…'}, REML, in lme4's words with "
        f"{factor.name} {codes} and {sums}; "
        f"t on {'n − groups' if context.design.groups else 'n − 1'}."
        + _reduced(first),
    )  # fmt: skip
    blocks: list[Block] = []
    for fit in fits:
        key = key_of(fit, factor, several)
        if is_defined(fit.p):
            start = f"{fit.level}: " if several else ""
            blocks.append(
                say(
                    f"{start}With every trial as a row and {_terms(fit)}: {{}}. "
                    f"{_same(context, fit, logs, several)}",
                    cited_ratio(table, key),
                )
            )
    scenes = scene_blocks(context, factor, first)
    return Section("sensitivity", TITLE, (*blocks, table, *scenes, *robust_blocks(context)))


def _row(fit: MixedEffect, factor: Factor, several: bool) -> dict[str, object]:
    return {
        "effect": key_of(fit, factor, several),
        "n": fit.n,
        "trials": fit.trials,
        **shared_values(fit),
        "sd_slope": fit.sd_slope,
        "sd_task_slope": fit.sd_task_slope,
    }


TERMS = dict(
    zip(
        MODELS,
        (
            "the effect free to differ between participants and between their tasks",
            "the effect free to differ between participants, levels between tasks too",
            "the effect free to differ between participants",
            "levels free to differ between participants",
        ),
        strict=True,
    )
)
"""What the random terms let differ."""


def _terms(fit: MixedEffect) -> str:
    return TERMS[fit.terms]


def _reduced(fit: MixedEffect) -> str:
    """What a reader of the table must know of the fit."""
    said = ""
    if fit.given_up:
        said += f" Given up for want of data: {'; '.join(fit.given_up)}."
    if fit.singular:
        said += (
            " The fit is singular: a variance is estimated as 0, or a correlation as ±1, which few "
            "participants or like ones can bring about; it is weak support for anything."
        )
    return said


WEAK = "The fit is singular, so that it does not count as agreement."


def _same(context: Context, fit: MixedEffect, logs: Table | None, several: bool) -> str:
    """Whether the contrast scores' conclusion on log times is the same; of a singular fit nothing
    is said to agree."""
    ending = f"/{context.design.main.name}={fit.level}" if several and context.design.main else ""
    key = next((str(r["measure"]) for r in logs.rows if str(r["measure"]).endswith(
        f"_overall{ending}")), None) if logs is not None else None  # fmt: skip
    if logs is None or key is None or not is_defined(logs.row(key)["p"]) or not is_defined(fit.p):
        return WEAK if fit.singular else ""
    alpha = context.plan.alpha
    same = (number_in(logs.row(key), "p") < alpha) == (fit.p < alpha)
    if same and fit.singular:
        return WEAK
    return (
        "The conclusion is that of the contrast scores."
        if same
        else "This differs from the contrast scores' conclusion: read both."
    )
