"""One of several options, or any of them."""

from seethrough.experiment.questions.choice.choice_question import ChoiceQuestion

QUESTION = ChoiceQuestion()
