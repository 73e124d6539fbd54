"""The same question asked of single trials by a mixed model."""

from __future__ import annotations

from analysis.mixed import MixedEffect, mixed_model
from analysis.page.blocks import Block, Column, Section, Table, say
from analysis.sections.context import Context
from analysis.stats.undefined import is_defined

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
)


def sensitivity_section(context: Context, logs: Table | None) -> Section:
    """Mixed model beside the contrast scores' answer."""
    fit = mixed_model(context.trials)
    table = Table(
        "mixed_model",
        "Mixed model of log times, all trials",
        COLUMNS,
        (_row(fit),),
        note="log time ~ transparency × task + (1 + transparency | participant), REML; t on n − 1.",
    )
    blocks: list[Block] = []
    if is_defined(fit.p):
        p = table.cite("transparency", "p")
        blocks.append(
            say(
                "With every trial as a row and a random slope of the technique for each "
                f"participant: ratio {{}}, 95 % CI [{{}}, {{}}], t({{}}) = {{}}, p "
                f"{'' if p.text.startswith('<') else '= '}{{}}. {_same(context, fit.p, logs)}",
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
    }


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
