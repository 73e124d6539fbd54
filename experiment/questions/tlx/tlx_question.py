"""NASA-TLX (Hart and Staveland 1988): six scales, and what weighs more of each two of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

from seethrough.experiment.pages.pages import Answers, Choice, Page, Paragraph, Scale
from seethrough.experiment.questions.kit import Asking, Respondent, Row, page, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts

TLX = ("mental", "physical", "temporal", "performance", "effort", "frustration")
STEPS = 21
PAIRS = tuple(combinations(TLX, 2))
ENDS = dict.fromkeys(TLX, ("tlx.low", "tlx.high")) | {"performance": ("tlx.good", "tlx.bad")}


@dataclass(frozen=True)
class TlxParameters:
    """What a study may say of it."""

    weighted: bool = key(
        False, "whether the scales are weighed against each other too, in 15 pairs on a second page"
    )

    def __post_init__(self) -> None:
        check(self)


class TlxQuestion:
    """How much work was it?"""

    name, version = "tlx", "2"
    source = "Hart and Staveland 1988"
    Parameters = TlxParameters
    example = TlxParameters(weighted=True)
    texts: Texts = NO_TEXTS

    def count(self, p: TlxParameters) -> int:
        """One, or two with the pairs."""
        return 2 if p.weighted else 1

    def pages(self, p: TlxParameters, asking: Asking) -> tuple[Page, ...]:
        """The scales; then the pairs, in an order of the participant's."""
        levels = tuple(asking.about.values())
        title = ".".join(("tlx", *levels)) if levels else "tlx.title"
        scales = tuple(
            Scale(f"tlx_{i}", f"tlx.{i}", *ENDS[i], STEPS, against=True) for i in TLX
        )  # fmt: skip
        first = page(asking, title, scales)
        if not p.weighted:
            return (first,)
        asked = tuple(
            Choice(f"tlx_pair_{number + 1}", "", tuple(f"tlx.factor.{name}" for name in pair))
            for number, pair in self._pairs(asking)
        )
        return (first, page(asking, "tlx.weights", (Paragraph("tlx.which"), *asked)))

    def _pairs(self, asking: Asking) -> list[tuple[int, tuple[str, str]]]:
        """Each pair with its number, shuffled, and either of the two first."""
        rng = asking.stream()
        order = rng.permutation(len(PAIRS))
        turned = rng.random(len(PAIRS)) < 0.5
        pairs = [(a, b) if not turn else (b, a) for (a, b), turn in zip(PAIRS, turned, strict=True)]
        return [(int(i), pairs[i]) for i in order]

    def rows(self, p: TlxParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """Six values from 0 to 20; or what was chosen of each pair, how often each scale was, and
        the weighted workload from 0 to 100."""
        if number == 0:
            return [row(f"tlx_{name}", answers[f"tlx_{name}"]) for name in TLX]
        first: dict[
            int, bool
        ] = {}  # of each pair, as it is numbered; what was answered before counts
        for which, pair in self._pairs(asking):
            now = pair[int(answers[f"tlx_pair_{which + 1}"])] == PAIRS[which][0]
            first[which] = bool(int(asking.given.get(f"tlx_pair_{which + 1}", now)))
        chosen = [PAIRS[n][0 if first[n] else 1] for n in range(len(PAIRS))]
        pairs = [
            row(f"tlx_pair_{n + 1}", str(int(first[n])), text=chosen[n]) for n in range(len(PAIRS))
        ]
        weights = {name: chosen.count(name) for name in TLX}
        load = sum(w * float(asking.given[f"tlx_{n}"]) for n, w in weights.items())
        load *= 100 / (STEPS - 1) / len(PAIRS)
        return [
            *pairs,
            *(row(f"tlx_weight_{name}", str(weight)) for name, weight in weights.items()),
            row("tlx_weighted", f"{load:.10g}"),
        ]

    def last(self, p: TlxParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The last scale; the workload."""
        return ("tlx_weighted",) if number else (f"tlx_{TLX[-1]}",)

    def behind(self, p: TlxParameters) -> tuple[str, ...]:
        """Pairs and weights lead to the weighted workload."""
        if not p.weighted:
            return ()
        pairs = tuple(f"tlx_pair_{n}" for n in range(1, len(PAIRS) + 1))
        return (*pairs, *(f"tlx_weight_{name}" for name in TLX))

    def items(self, p: TlxParameters, name: str) -> Mapping[str, str]:
        """All of it."""
        found = {f"tlx_{name}": f"tlx.{name} (0–{STEPS - 1})" for name in TLX}
        if p.weighted:
            found |= {
                f"tlx_pair_{n}": f"{a} (1) or {b} (0)" for n, (a, b) in enumerate(PAIRS, start=1)
            }
            found |= {f"tlx_weight_{name}": f"how often {name} was chosen, of 5" for name in TLX}
            found["tlx_weighted"] = "weighted workload (0–100)"
        return found

    def simulate(self, p: TlxParameters, page: Page, person: Respondent) -> Answers:
        """By what the pages are made of."""
        return person.by_blocks(page)
