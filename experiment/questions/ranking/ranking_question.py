"""A ranking: of options of the study's own, or of the levels of a factor."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.pages import Answers, Ranking
from seethrough.experiment.questions.kit import Asking, OnOnePage, Possible, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class RankingParameters:
    """What a study may say of a ranking."""

    text: str = key(..., "what is asked; 1 is first", shown=True)
    options: tuple[str, ...] = key(
        (), "what is put in order; none: the levels that are compared (`of`)",
        said="an array of two or more texts, each once", shown=True)  # fmt: skip
    shuffle: bool = key(False, "whether each participant has the options in another order")
    required: bool = key(True, "the page goes on only when all have a rank")
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)
        if self.options and (len(self.options) < 2 or len(set(self.options)) < len(self.options)):
            expected = "an array of two or more texts, each once"
            raise ValueError(f"options = {list(self.options)!r}, expected {expected}")

    def asked(self, asking: Asking) -> list[tuple[str, str]]:
        """(text, name) of each option, in the order of this participant."""
        texts = self.options or tuple(f"name.{level}" for level in asking.of)
        found = list(zip(texts, self.options or asking.of, strict=True))
        return (
            [found[i] for i in asking.stream().permutation(len(found))] if self.shuffle else found
        )


class RankingQuestion(OnOnePage[RankingParameters]):
    """In which order?"""

    name, version = "ranking", "1"
    source = "ours"
    Parameters = RankingParameters
    example = RankingParameters(
        text="Put these in order; 1 is best.", options=("red", "green", "blue")
    )
    texts: Texts = NO_TEXTS

    def blocks(self, p: RankingParameters, asking: Asking) -> tuple[Ranking, ...]:
        """All options; of levels, each speaks for itself."""
        options = p.asked(asking)
        prefer = () if p.options else tuple(name for _, name in options)
        texts = tuple(text for text, _ in options)
        return (Ranking(asking.name, p.text, texts, prefer, not p.required),)

    def rows(
        self, p: RankingParameters, asking: Asking, number: int, answers: Answers
    ) -> list[Row]:
        """Each option's rank, a row each."""
        ranks = answers.get(asking.name, "").split(",")
        shown = [name for _, name in p.asked(asking)]
        if len(ranks) != len(shown) or "" in ranks:
            return []
        rank_of = dict(zip(shown, ranks, strict=True))
        return [
            row(f"{asking.name}_{n}", rank_of[name], text=name)
            for n, name in enumerate(p.options or asking.of, start=1)
        ]

    def last(self, p: RankingParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The last option."""
        return (f"{asking.name}_{len(p.options or asking.of)}",)

    def possible(self, p: RankingParameters, item: str) -> Possible | None:
        """A rank, or the option's name."""
        if not p.options:
            return None
        return Possible(1, len(p.options), frozenset(p.options))

    def items(self, p: RankingParameters, name: str) -> dict[str, str]:
        """Each option's rank."""
        return {f"{name}_{n}": f"{p.text} {o} (rank)" for n, o in enumerate(p.options, start=1)}
