"""Point at the marked thing."""

from seethrough.tasks.select.select_task import Select

TASK = Select()
