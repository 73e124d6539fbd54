"""Yes or no."""

from dataclasses import dataclass

from seethrough.api import OnOnePage, check, key, pages, row


@dataclass(frozen=True)
class Asked:
    text: str = key(..., "what is asked", shown=True)
    title: str = key("toy_question.title", "stands above the page", shown=True)

    def __post_init__(self):
        check(self)


class Toy(OnOnePage):
    name, version, source, Parameters = "toy_question", "1", "nobody", Asked
    example = Asked("Did you enjoy it?")
    texts = {
        "en": {"toy_question.title": "Yes or no", "toy_question.yes": "yes",
               "toy_question.no": "no"},
        "de": {"toy_question.title": "Ja oder nein", "toy_question.yes": "ja",
               "toy_question.no": "nein"},
    }  # fmt: skip

    def blocks(self, p, asking):
        return (pages.Choice(asking.name, p.text, ("toy_question.no", "toy_question.yes")),)

    def rows(self, p, asking, number, answers):
        return [row(asking.name, answers[asking.name])]

    def items(self, p, name):
        return {name: f"{p.text} (1: yes)"}


QUESTION = Toy()
