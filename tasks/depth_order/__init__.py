"""Which of two marked things is nearer?"""

from seethrough.tasks.depth_order.depth_order_task import DepthOrder

TASK = DepthOrder()
