"""For these scenes only, or for scenes like these: the mixed model with scenes as a sample."""

from __future__ import annotations

from seethrough.analysis.design import Factor
from seethrough.analysis.mixed import MixedEffect
from seethrough.analysis.page.blocks import Block, Column, Prose, Table, say
from seethrough.analysis.scenes import FEWEST, SCENE_SLOPES, SceneEffect, Scenes, scene_model
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
from seethrough.analysis.stats.undefined import is_defined

COLUMNS = (
    EFFECT,
    Column("scenes", "scenes", "int", "that two people or more met"),
    Column("trials", "trials", "int"),
    *TESTED,
    Column("ratio", "ratio", "fixed3", "level / baseline", "low", "high"),
    *INTERVAL,
    Column("sd_scene", "SD of scenes", "fixed3"),
    Column("sd_slope", "SD of slopes", "fixed3", "between scenes"),
    *FITTED,
)
SHOWN = tuple("scenes estimate error t df p ratio sd_scene sd_slope singular".split())
ONLY = "so that what was found is for these scenes only."


def scene_blocks(context: Context, factor: Factor, plain: MixedEffect) -> list[Block]:
    """A table where scenes are a random effect, else why they are none; nothing where nobody shares
    a scene."""
    found = scene_model(context.trials, context.design, plain)
    if not found.shared:
        return []
    if not found.effects:
        return [_none(found)]
    several = len(found.effects) > 1
    rows = tuple(_row(e, factor, several) for e in found.effects)
    note = (
        f"log time as above, + {found.effects[0].model.rpartition(' + ')[2]}: scenes are a sample, "
        "crossed with the participants (0 in trials whose scene nobody else met). t on the smaller "
        "of the participants' and the scenes' degrees of freedom."
    )
    if found.given_up:
        note += f" Given up: {'; '.join(found.given_up)}."
    if found.effects[0].singular:
        note += " The participants' terms are singular: weak support for anything."
    shown = ("effect", *SHOWN) if several else SHOWN
    table = Table("mixed_scenes", "Mixed model of log times, for scenes like these", COLUMNS, rows,
                  shown, note)  # fmt: skip
    return [*(_sentence(context, table, e, factor, plain, several) for e in found.effects), table]


def _none(found: Scenes) -> Prose:
    said = f"{found.shared} scenes were met by several people"
    if found.given_up:
        steps = "; ".join(found.given_up)
        said += f", as a random effect: {steps}. They are none in the model above, {ONLY}"
    elif found.shared < FEWEST:
        said += f". Fewer than {FEWEST} are no sample, {ONLY}"
    else:
        said += f". The model above was not fitted, nor is one with them, {ONLY}"
    return say("{}", [said], kind="note")


def _row(effect: SceneEffect, factor: Factor, several: bool) -> dict[str, object]:
    return {
        "effect": key_of(effect, factor, several),
        "scenes": effect.scenes,
        "trials": effect.trials,
        **shared_values(effect),
        "sd_scene": effect.sd_scene,
        "sd_slope": effect.sd_slope,
    }


def _sentence(
    context: Context, table: Table, effect: SceneEffect, factor: Factor, plain: MixedEffect,
    several: bool,
) -> Prose:  # fmt: skip
    key, alpha = key_of(effect, factor, several), context.plan.alpha
    shown = "" if effect.p < alpha else "no difference is shown "
    what = "effect" if effect.step == SCENE_SLOPES else "level"
    start = f"{effect.level}, for" if several else "For"
    also = ""
    if not several and is_defined(plain.p) and (plain.p < alpha) != (effect.p < alpha):
        also = " This differs from the model without scenes: what it shows may be these scenes'."
    return say(
        f"{start} scenes like these {shown}(each scene's {what} free): {{}}.{also}",
        cited_ratio(table, key),
    )
