"""Shapes in a volume."""

from seethrough.tasks.worlds.abstract.abstract_world import Abstract

WORLD = Abstract()
