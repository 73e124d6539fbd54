"""Words of one's own."""

from seethrough.experiment.questions.text.text_question import TextQuestion

QUESTION = TextQuestion()
