"""Rooms to walk through."""

from seethrough.tasks.worlds.building.building_world import BuildingWorld

WORLD = BuildingWorld()
