"""The study that plays the toys of tests/plugins: installed, or in files that lie beside it."""


def toy_study(level: str, technique: str, brought: bool = False) -> str:
    """The text of a study file: our technique against another, at a `level` of this name, and the
    toys' task, world and question among ours. `brought`: whether it names the toys' files."""

    def file(kind: str) -> str:
        return f'file = "toy_{kind}.py"\n' if brought else ""

    own = ""
    if brought:
        own = f"""[technique.toy]
{file("technique")}distance = 9.0
[task.toy_task]
{file("task")}unsure = true
confidence = true
[question.toy_question]
{file("question")}"""
    return f"""
[study]
name = "toys"
title = "Toys"
description = "What comes from elsewhere, among ours."
participants = 2
seed = 1
[display]
width = 160
height = 120
[factors.view]
levels.plain = {{ technique.use = "standard" }}
levels.{level} = {{ technique.use = "{technique}" }}
[factors.place]
levels.cube = {{ world.use = "abstract", design.tasks = ["toy_task"] }}
levels.row = {{ world.use = "toy_world", design.tasks = ["depth_order"] }}
[world.abstract]
objects = 40
[world.toy_world]
{file("world")}balls = 8
{own}[design]
trials = 1
[questions]
liked = {{ use = "toy_question", when = "condition", text = "Did you like it?" }}
"""
