"""The smallest studies with both levels: a small scene of the abstract world."""

COMPARISON = 'comparison = { when = "end", of = "transparency" }\n'


def small_study(
    title: str,
    description: str,
    tasks: str = '"count", "pattern"',
    participants: int = 1,
    trials: int = 1,
    practice: int = 0,
    questions: str = "",
) -> str:
    """The text of a study file, whose name is the title's first word; `tasks` and `questions` as
    the file has them."""
    return f"""
[study]
name = "{title.split()[0].lower()}"
title = "{title}"
description = "{description}"
participants = {participants}
seed = 5
[design]
tasks = [{tasks}]
trials = {trials}
[factors.transparency]
levels.standard = {{ technique.use = "standard" }}
levels.dynamic = {{ technique.use = "dynamic" }}
[world.abstract]
side = 50.0
objects = 60
target_share = [0.3, 0.4]
[world]
use = "abstract"
[practice]
trials = {practice}
[questions] # in this order
{questions}"""


SMALL = small_study(
    "Small", "The smallest study: both levels of one task, a small scene.", '"pattern"',
    participants=3, questions=COMPARISON,
)  # fmt: skip
