"""Workload on six scales, raw or weighted."""

from seethrough.experiment.questions.tlx.tlx_question import TlxQuestion

QUESTION = TlxQuestion()
