"""All options in an order."""

from seethrough.experiment.questions.ranking.ranking_question import RankingQuestion

QUESTION = RankingQuestion()
