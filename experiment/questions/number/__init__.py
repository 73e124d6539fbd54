"""A number that is typed."""

from seethrough.experiment.questions.number.number_question import NumberQuestion

QUESTION = NumberQuestion()
