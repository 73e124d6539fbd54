"""Statements that one agrees with more or less."""

from seethrough.experiment.questions.likert.likert_question import LikertQuestion

QUESTION = LikertQuestion()
