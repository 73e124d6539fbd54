"""What the tables of mixed models share: columns, a row's values, and the effect in a sentence."""

from __future__ import annotations

from seethrough.analysis.design import Factor
from seethrough.analysis.mixed import MixedEffect
from seethrough.analysis.page.blocks import Cited, Column, Table
from seethrough.analysis.page.numbers import equals
from seethrough.analysis.scenes import SceneEffect

EFFECT = Column("effect", "effect")
TESTED = (
    Column("estimate", "estimate", "fixed4", "log time"),
    Column("error", "s.e.", "fixed4"),
    Column("t", "t", "fixed2"),
    Column("df", "df", "int"),
    Column("p", "p", "p"),
)
INTERVAL = (
    Column("low", "from", "fixed3", "95 % interval"),
    Column("high", "to", "fixed3", "95 % interval"),
)
FITTED = (Column("model", "random terms"), Column("singular", "singular?"))


def key_of(effect: MixedEffect | SceneEffect, factor: Factor, several: bool) -> str:
    """The key of an effect's row: the factor, with the level where there are several."""
    return f"{factor.name}={effect.level}" if several else factor.name


def shared_values(effect: MixedEffect | SceneEffect) -> dict[str, object]:
    """A row's values in `TESTED`, `INTERVAL` and `FITTED`, and the ratio."""
    return {
        "estimate": effect.estimate,
        "error": effect.error,
        "t": effect.t,
        "df": effect.df,
        "p": effect.p,
        "ratio": effect.ratio,
        "low": effect.interval[0],
        "high": effect.interval[1],
        "model": effect.model,
        "singular": effect.singular,
    }


def cited_ratio(table: Table, key: str) -> list[str | Cited]:
    """`ratio 0.81, 95 % CI [0.70, 0.93], t(15) = −3.20, p = .006` of a row."""
    ratio, low, high, df, t, p = (
        table.cite(key, name) for name in ("ratio", "low", "high", "df", "t", "p")
    )
    return ["ratio ", ratio, ", 95 % CI [", low, ", ", high, "], t(", df, ") = ", t,
            f", p {equals(p.text)}", p]  # fmt: skip
