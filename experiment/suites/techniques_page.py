"""The reference of techniques, docs/techniques.md, from what they declare and what was measured.

`python -m seethrough.experiment.suites.techniques_page` writes it anew.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from seethrough import registry
from seethrough.experiment.gallery.gallery_failures import failures
from seethrough.experiment.generated import write_anew
from seethrough.experiment.suites.requirements import SHOWS, VIEWS, measure
from seethrough.renderer.techniques.base import Technique

REFERENCE = Path(__file__).resolve().parents[2] / "docs" / "techniques.md"

ABOUT = f"""# Techniques

Written by `python -m seethrough.experiment.suites.techniques_page`; the keys of each are in
[keys.md](keys.md), pictures in `seethrough gallery`.

## What visualization asks, measured

R1 to R7 are the requirements of Elmqvist2009 §IV: R1 targets show wherever one looks from, R2
behind any number of layers, R3 nothing but what is before the target changes, R4 polygons, R5 real
time, R6 nobody has to do anything, R7 context stays. Measured on exact pictures with default
parameters: R1 how many hidden targets of a room come to show (at least {100 * SHOWS:.0f} % of their
area), from {VIEWS} sides, and the least share of one; R2 behind how many panes a ball still shows;
R3 how much of a large wall stays as it was with a small target behind it; R7 how much of the area
of everything else stays. Where hands work a technique they reach for each target. R5 is a matter of
the machine: `seethrough bench techniques`, whose last table is in
[benchmarks/README.md](../benchmarks/README.md). Beside it stands what the paper's text says of the
kind of technique; it had other implementations, and an empty cell is one that it does not treat.
"""


def page() -> str:
    """The whole reference."""
    return "\n".join([ABOUT, *_table(), "", *_each()]) + "\n"


def _table() -> Iterator[str]:
    columns = ("R1", "R2", "R3", "R4", "R6", "R7")
    yield "| technique | " + " | ".join(columns) + " | Elmqvist2009 |"
    yield "| --- " * (len(columns) + 2) + "|"
    for name in _ours():
        technique = registry.get("technique", name)
        words = measure(technique).words()
        cells = " | ".join(words[c] for c in columns)
        yield f"| {name} | {cells} | {technique.misses} |"


def _ours() -> tuple[str, ...]:
    return tuple(
        name for name in registry.known("technique") if registry.origin("technique", name) is None
    )


def _each() -> Iterator[str]:
    failing = failures()
    for name in _ours():
        technique: Technique = registry.get("technique", name)
        yield f"## {name}: {technique.title}\n"
        yield f"{technique.instruction} Source: {technique.source}.\n"
        if technique.controls in technique.texts.get("en", {}):
            yield f"Hands: {technique.texts['en'][technique.controls]}\n"
        yield f"Fails: {failing[name].words[:1].lower()}{failing[name].words[1:]}.\n"


if __name__ == "__main__":
    sys.exit(write_anew(REFERENCE, page, "It measures every technique: minutes."))
