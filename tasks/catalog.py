"""The tasks by name."""

from __future__ import annotations

from tasks.base import Task
from tasks.count import Count
from tasks.count_in_building import CountInBuilding
from tasks.pattern import Pattern
from tasks.unique import Unique

TASKS: dict[str, Task] = {t.name: t for t in (Count(), Pattern(), Unique(), CountInBuilding())}
