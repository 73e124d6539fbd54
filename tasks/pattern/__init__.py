"""T2: which letter do the targets form?"""

from seethrough.tasks.pattern.pattern_task import Pattern

TASK = Pattern()
