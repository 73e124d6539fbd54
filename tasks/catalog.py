"""The tasks by name."""

from __future__ import annotations

from seethrough.tasks.base import Task
from seethrough.tasks.count import Count
from seethrough.tasks.count_in_building import CountInBuilding
from seethrough.tasks.pattern import Pattern
from seethrough.tasks.unique import Unique

TASKS: dict[str, Task] = {t.name: t for t in (Count(), Pattern(), Unique(), CountInBuilding())}
