"""Something to read, and perhaps to agree to."""

from seethrough.experiment.questions.statement.statement_question import StatementQuestion

QUESTION = StatementQuestion()
