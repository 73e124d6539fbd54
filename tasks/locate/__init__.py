"""Where is the named part?"""

from seethrough.tasks.locate.locate_task import Locate

TASK = Locate()
