"""What participants read of levels: the study's own words, else the ones that ship, else labels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache

from seethrough.experiment.pages.pages import Block, Choice, Page, Paragraph, Ranking
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.study.design.design import Trial
from seethrough.experiment.study.design.factors import ALONE, Levels
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.translations import own_words

Pairs = tuple[tuple[str, str], ...]  # factor and level


@cache
def _shipped() -> frozenset[str]:
    """Every language has the same texts."""
    return Texts("en").keys()


def known(study: Study, key: str) -> bool:
    """Whether there is a text of this name."""
    return key in study.texts or key in _shipped()


def of_blocks(study: Study, levels: Levels) -> Pairs:
    """The levels of a condition: of the factors that make blocks."""
    return tuple((f.name, levels[f.name]) for f in study.factors if f.block)


def name(study: Study, factor: str, level: str) -> str:
    """What a level is called: a text's key, or its label."""
    label = study.factor(factor).level(level).label
    if label:
        return label
    return f"name.{level}" if known(study, f"name.{level}") else level


def instructions(study: Study, levels: Levels) -> Iterable[Paragraph]:
    """What is said before a task set of each level that one could not see otherwise."""
    for factor in study.factors:
        if not factor.block or factor.scenes != ALONE:
            continue
        level = levels[factor.name]
        key = f"{factor.name}.{level}"
        if known(study, key):
            yield Paragraph(key)
        elif label := factor.level(level).label:
            yield Paragraph("level.here", (("level", label),))


def hands(study: Study, trial: Trial) -> Iterable[Paragraph]:
    """What the participant's hands do for the technique, where it depends on them."""
    technique = study.part(trial.levels).technique
    if technique.technique.active(technique):
        walking = ".walking" if study.setting(trial).world.moving == "walk" else ""
        yield Paragraph(f"{technique.technique.controls}{walking}")


def named(study: Study, page: Page, pairs: Iterable[tuple[str, str]], language: str) -> Page:
    """A page about some levels, with the study's words for each: in its title where there is no
    text of that name, and wherever it names a level."""
    said = {f"name.{level}": name(study, factor, level) for factor, level in pairs}
    title = page.title
    named_after = "".join(f".{level}" for _, level in page.about)  # as ready-made pages are
    if page.about and title.endswith(named_after) and not known(study, title):
        told = own_words(study, language)
        labels = [study.factor(f).level(level).label or level for f, level in page.about]
        title = ", ".join(told.get(label, label) for label in labels)
        title = title[:1].upper() + title[1:]
    return replace(page, title=title, blocks=tuple(_block(block, said) for block in page.blocks))


def _block(block: Block, said: Mapping[str, str]) -> Block:
    if isinstance(block, Paragraph):
        return replace(block, text=said.get(block.text, block.text))
    if isinstance(block, Choice | Ranking):
        return replace(block, options=tuple(said.get(o, o) for o in block.options))
    return block
