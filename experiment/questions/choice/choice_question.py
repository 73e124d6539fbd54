"""A choice: one of several options, or any of them."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.experiment.pages.pages import Answers, Choice, Several
from seethrough.experiment.questions.kit import Asking, OnOnePage, Possible, Row, row
from seethrough.renderer.declared import check, key
from seethrough.tasks.kit.world import NO_TEXTS, Texts


@dataclass(frozen=True)
class ChoiceParameters:
    """What a study may say of a choice."""

    text: str = key(..., "what is asked", shown=True)
    options: tuple[str, ...] = key(
        (), "what there is to choose from; none: the levels that are compared (`of`)",
        said="an array of two or more texts, each once", shown=True)  # fmt: skip
    names: tuple[str, ...] = key(
        (), "what the data call the options; none: as participants read them",
        said="an array of texts, one for each option",
    )  # fmt: skip
    right: str = key("", "name of the option that counts 1, all others 0; none: its place counts")
    numbered: bool = key(True, "whether the option's place is the value; its name is the text")
    several: bool = key(False, "whether more than one may be chosen")
    required: bool = key(True, "the page goes on only when it is answered")
    shuffle: bool = key(False, "whether each participant has the options in another order")
    title: str = key("", "stands above the page; none: which levels it is about", shown=True)

    def __post_init__(self) -> None:
        check(self)
        if self.options and (len(self.options) < 2 or len(set(self.options)) < len(self.options)):
            expected = "an array of two or more texts, each once"
            raise ValueError(f"options = {list(self.options)!r}, expected {expected}")
        if self.names and len(self.names) != len(self.options):
            raise ValueError(f"names = {list(self.names)!r}, expected one for each option")
        if len(set(self.names)) < len(self.names):
            raise ValueError(f"names = {list(self.names)!r}, expected each once")
        if self.right and self.right not in (self.names or self.options):
            raise ValueError(f"right = {self.right!r}, expected the name of an option")

    def asked(self, asking: Asking) -> list[tuple[str, str]]:
        """(text, name) of each option, in the order of this participant."""
        options = self.options or tuple(f"name.{level}" for level in asking.of)
        names = self.names or (self.options or asking.of)
        found = list(zip(options, names, strict=True))
        if self.shuffle:
            return [found[i] for i in asking.stream().permutation(len(found))]
        return found


class ChoiceQuestion(OnOnePage[ChoiceParameters]):
    """Which?"""

    name, version = "choice", "1"
    source = "ours"
    Parameters = ChoiceParameters
    example = ChoiceParameters(text="What did you use?", options=("keyboard", "mouse"))
    texts: Texts = NO_TEXTS

    def blocks(self, p: ChoiceParameters, asking: Asking) -> tuple[Choice | Several, ...]:
        """The options."""
        pairs = p.asked(asking)
        options = tuple(text for text, _ in pairs)
        if p.several:
            return (Several(asking.name, p.text, options, not p.required),)
        prefer = tuple(name if name in asking.of else "" for _, name in pairs)
        known = prefer if any(prefer) else ()
        return (Choice(asking.name, p.text, options, not p.required, known),)

    def rows(self, p: ChoiceParameters, asking: Asking, number: int, answers: Answers) -> list[Row]:
        """The option by its name; of several, a row each that says whether it was chosen."""
        pairs, answer = p.asked(asking), answers.get(asking.name, "")
        names = [name for _, name in pairs]
        if p.several:
            chosen = {int(n) for n in answer.split(",") if n}
            order = p.names or p.options or asking.of
            return [
                row(f"{asking.name}_{n}", str(int(names.index(name) in chosen)), text=name)
                for n, name in enumerate(order, start=1)
            ]
        if not answer:
            return []
        name = names[int(answer)]
        return [row(asking.name, self._value(p, asking, name), text=name)]

    def _value(self, p: ChoiceParameters, asking: Asking, name: str) -> str:
        if not p.numbered:
            return ""
        if p.right:
            return str(int(name == p.right))
        return str(1 + (p.names or p.options or asking.of).index(name))

    def last(self, p: ChoiceParameters, asking: Asking, number: int) -> tuple[str, ...]:
        """The last row."""
        count = len(p.options or asking.of)
        return (f"{asking.name}_{count}",) if p.several else (asking.name,)

    def possible(self, p: ChoiceParameters, item: str) -> Possible | None:
        """The place of an option, or whether it was chosen; or its name."""
        names = frozenset(p.names or p.options)
        if not names:
            return None
        if p.several or p.right:
            return Possible(0, 1, names)
        return Possible(1, len(names), names) if p.numbered else Possible(1, 0, names)

    def items(self, p: ChoiceParameters, name: str) -> dict[str, str]:
        """The choice."""
        if not p.several:
            return {name: p.text}
        return {f"{name}_{n}": f"{p.text} {o} (1: chosen)" for n, o in enumerate(p.options, 1)}
