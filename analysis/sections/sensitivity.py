"""The same question asked of single trials by a mixed model."""

from __future__ import annotations

from seethrough.analysis.mixed import MODELS, MixedEffect, mixed_model
from seethrough.analysis.page.blocks import Block, Column, Section, Table, say
from seethrough.analysis.sections.context import Context
from seethrough.analysis.stats.undefined import is_defined

COLUMNS = (
    Column("effect", "effect"),
    Column("n", "n", "int"),
    Column("trials", "trials", "int"),
    Column("estimate", "estimate", "fixed4", "log time"),
    Column("error", "s.e.", "fixed4"),
    Column("t", "t", "fixed2"),
    Column("df", "df", "int"),
    Column("p", "p", "p"),
    Column("ratio", "ratio", "fixed3", "dynamic / standard"),
    Column("low", "from", "fixed3", "95 % interval"),
    Column("high", "to", "fixed3", "95 % interval"),
    Column("sd_slope", "SD of slopes", "fixed3", "between participants"),
    Column("sd_task_slope", "SD of slopes", "fixed3", "between tasks of a participant"),
    Column("model", "random terms"),
    Column("singular", "singular?"),
)
SHOWN = tuple("n trials estimate error t df p ratio sd_slope sd_task_slope singular".split())


def sensitivity_section(context: Context, logs: Table | None) -> Section:
    """Mixed model beside the contrast scores' answer."""
    fit = mixed_model(context.trials)
    table = Table(
        "mixed_model",
        "Mixed model of log times, all trials",
        COLUMNS,
        (_row(fit),),
        SHOWN,
        note=f"log time ~ transparency × task + {fit.model or '…'}, REML, in lme4's words with "
        "transparency −½ and ½ and tasks sum-coded; t on n − 1." + _reduced(fit),
    )
    blocks: list[Block] = []
    if is_defined(fit.p):
        p = table.cite("transparency", "p")
        blocks.append(
            say(
                f"With every trial as a row and {TERMS[fit.model]}: ratio {{}}, 95 % CI "
                "[{}, {}], t({}) = {}, p "
                f"{'' if p.text.startswith(('<', '>')) else '= '}{{}}. "
                f"{_same(context, fit.p, logs)}",
                table.cite("transparency", "ratio"),
                table.cite("transparency", "low"),
                table.cite("transparency", "high"),
                table.cite("transparency", "df"),
                table.cite("transparency", "t"),
                p,
            )
        )
    return Section("sensitivity", "Does the model matter?", (*blocks, table))


def _row(fit: MixedEffect) -> dict[str, object]:
    return {
        "effect": "transparency",
        "n": fit.n,
        "trials": fit.trials,
        "estimate": fit.estimate,
        "error": fit.error,
        "t": fit.t,
        "df": fit.n - 1,
        "p": fit.p,
        "ratio": fit.ratio,
        "low": fit.interval[0],
        "high": fit.interval[1],
        "sd_slope": fit.sd_slope,
        "sd_task_slope": fit.sd_task_slope,
        "model": fit.model,
        "singular": fit.singular,
    }


TERMS = {
    " + ".join(names): words
    for names, words in zip(
        MODELS,
        (
            "the technique's effect free to differ between participants and between their tasks",
            "the technique's effect free to differ between participants, levels between tasks too",
            "the technique's effect free to differ between participants",
            "levels free to differ between participants, who have one trial a level each",
        ),
        strict=True,
    )
}
"""What the random terms let differ."""


def _reduced(fit: MixedEffect) -> str:
    """What a reader of the table must know of the fit."""
    said = ""
    if fit.singular:
        said += (
            " The fit is singular: a variance is estimated as 0, or a correlation as ±1, which few "
            "participants or like ones can bring about; the test of the effect stands."
        )
    return said


def _same(context: Context, p: float, logs: Table | None) -> str:
    """Whether the contrast scores' conclusion on log times is the same."""
    if logs is None or "time_overall" not in [r["measure"] for r in logs.rows]:
        return ""
    own = logs.row("time_overall")
    if not is_defined(own["p"]):
        return ""
    alpha = context.plan.alpha
    same = (own["p"] < alpha) == (p < alpha)
    return (
        "The conclusion is that of the contrast scores."
        if same
        else "This differs from the contrast scores' conclusion: read both."
    )
