"""T3: where is the thing that occurs once?"""

from seethrough.tasks.unique.unique_task import Unique

TASK = Unique()
