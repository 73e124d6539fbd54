"""`seethrough world`: what worlds there are, and whether one is what a world has to be."""

from functools import partial

from seethrough.experiment.suites import command

add_arguments = partial(command.add_arguments, "world")
run = partial(command.run, "world")
