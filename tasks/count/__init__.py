"""T1: how many targets are there?"""

from seethrough.tasks.count.count_task import Count

TASK = Count()
