"""The smallest study with both levels: one task, a small scene, a trial each."""

SMALL = """
[study]
name = "small"
title = "Small"
description = "The smallest study: both levels of one task, a small scene."
participants = 3
seed = 5
[design]
tasks = ["pattern"]
trials = 1
[factors.transparency]
levels.standard = { technique.use = "standard" }
levels.dynamic = { technique.use = "dynamic" }
[world.abstract]
side = 50.0
objects = 60
target_share = [0.3, 0.4]
[world]
use = "abstract"
[practice]
trials = 0
[questions] # in this order
comparison = { when = "end", of = "transparency" }
"""
