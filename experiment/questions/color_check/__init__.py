"""Plates that tell who confuses red and green."""

from seethrough.experiment.questions.color_check.color_question import ColorQuestion

QUESTION = ColorQuestion()
