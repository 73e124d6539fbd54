"""Which of two things in a still is nearer."""

from seethrough.experiment.questions.depth_test.depth_question import DepthQuestion

QUESTION = DepthQuestion()
