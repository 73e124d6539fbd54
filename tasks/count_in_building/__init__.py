"""T4: how many targets are in the building?"""

from seethrough.tasks.count_in_building.count_in_building_task import CountInBuilding

TASK = CountInBuilding()
