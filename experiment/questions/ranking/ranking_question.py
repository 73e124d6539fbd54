"""A ranking: of options of the study's own, or of the levels of a factor."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.pages import Answers, Ranking
from seethrough.experiment.questions.kit import Asking, OnOnePage, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class RankingParameters:
    """What a study may say of a ranking."""

    text: str = key(..., "what is asked; 1 is first")
    options: tuple[str, ...] = key(
        (), "what is put in order; none: the levels that are compared (`of`)",
        said="an array of two or more texts, each once",
    )  # fmt: skip
    required: bool = key(True, "the page goes on only when all have a rank")
    title: str = key("", "stands above the page; none: which levels it is about")

    def __post_init__(self) -> None:
        check(self)
        if self.options and (len(self.options) < 2 or len(set(self.options)) < len(self.options)):
            expected = "an array of two or more texts, each once"
            raise ValueError(f"options = {list(self.options)!r}, expected {expected}")


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
        options = p.options or tuple(f"name.{level}" for level in asking.of)
        prefer = () if p.options else asking.of
        return (Ranking(asking.name, p.text, options, prefer, not p.required),)

    def rows(
        self, p: RankingParameters, asking: Asking, number: int, answers: Answers
    ) -> list[Row]:
        """Each option's rank, a row each."""
        ranks = answers.get(asking.name, "").split(",")
        names = p.options or asking.of
        if len(ranks) != len(names) or "" in ranks:
            return []
        return [
            row(f"{asking.name}_{n}", rank, text=name)
            for n, (name, rank) in enumerate(zip(names, ranks, strict=True), start=1)
        ]

    def last(self, p: RankingParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The last option."""
        return (f"{asking.name}_{len(p.options or asking.of)}",)

    def items(self, p: RankingParameters, name: str) -> dict[str, str]:
        """Each option's rank."""
        return {f"{name}_{n}": f"{p.text} {o} (rank)" for n, o in enumerate(p.options, start=1)}
