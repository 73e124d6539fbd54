"""`seethrough question`: what kinds of question there are, whether one is what it has to be."""

from functools import partial

from seethrough.experiment.suites import command

add_arguments = partial(command.add_arguments, "question")
run = partial(command.run, "question")
