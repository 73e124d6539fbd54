"""`seethrough task`: what tasks there are, and whether one is what a task has to be."""

from functools import partial

from seethrough.experiment.suites import command

add_arguments = partial(command.add_arguments, "task")
run = partial(command.run, "task")
