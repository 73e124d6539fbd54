"""A whole number between two ends, by a slider."""

from seethrough.experiment.questions.slider.slider_question import SliderQuestion

QUESTION = SliderQuestion()
