"""The tasks by name."""

from __future__ import annotations

from seethrough.tasks.count.count_task import Count
from seethrough.tasks.count_in_building.count_in_building_task import CountInBuilding
from seethrough.tasks.kit.base import Task
from seethrough.tasks.pattern.pattern_task import Pattern
from seethrough.tasks.unique.unique_task import Unique

TASKS: dict[str, Task] = {t.name: t for t in (Count(), Pattern(), Unique(), CountInBuilding())}
