"""The static depth test as a question: a page for each pair, and a score."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.questions.depth_test.depth_pairs import PAIRS, DepthTest, depth_test
from seethrough.experiment.questions.kit import Asking, Respondent, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class DepthParameters:
    """What a study may say of the depth test."""

    world: str = key("building", "the world that the still is taken in", said="name of a world")

    def __post_init__(self) -> None:
        check(self)


class DepthQuestion:
    """Which of the two is nearer? Drawn with the technique of the levels that it is asked for."""

    name, version = "depth_test", "1"
    source = "Elmqvist2009 §VI-G"
    Parameters = DepthParameters
    example = DepthParameters()
    texts: Texts = NO_TEXTS

    def count(self, p: DepthParameters) -> int:
        """One for each pair."""
        return PAIRS

    def pages(self, p: DepthParameters, asking: Asking) -> tuple[Page, ...]:
        """The picture with each pair."""
        assert asking.study is not None, "a still shows a study's world"
        study, about = asking.study, asking.about
        return tuple(self._test(p, asking).pages(study.technique(about), study.look(about)))

    def rows(self, p: DepthParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """1 where it was right. The last brings the score."""
        rows = [row(f"depth_pair_{number + 1}", str(int(self._right(p, asking, number, answers))))]
        if number == PAIRS - 1:
            before = [asking.given[f"depth_pair_{n}"] for n in range(1, PAIRS)]
            score = [*before, rows[0]["value"]].count("1")
            rows.append(row("depth_test", str(score)))
        return rows

    def last(self, p: DepthParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The pair, or the score."""
        return ("depth_test" if number == PAIRS - 1 else f"depth_pair_{number + 1}",)

    def items(self, p: DepthParameters, name: str) -> dict[str, str]:
        """Each pair and the score."""
        pairs = {f"depth_pair_{n}": "1: the nearer one was named" for n in range(1, PAIRS + 1)}
        return {**pairs, "depth_test": f"right of {PAIRS}"}

    def simulate(self, p: DepthParameters, page: Page, person: Respondent) -> Answers:
        """By how near the things look."""
        return person.by_blocks(page)

    def _test(self, p: DepthParameters, asking: Asking) -> DepthTest:
        assert asking.study is not None, "a still shows a study's world"
        return depth_test(asking.study.seed, p.world, asking.study.place(p.world))

    def _right(self, p: DepthParameters, asking: Asking, number: int, answers: Answers) -> bool:
        return self._test(p, asking).right(number, answers)
