"""Which digit stands on the sign?"""

from seethrough.tasks.read.read_task import Read

TASK = Read()
