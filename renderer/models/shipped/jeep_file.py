"""The jeep as a scene of its own: an engine's parts to be found through the body. Metres."""

from __future__ import annotations

import numpy as np

from seethrough.renderer.models.forms.shapes import Shape
from seethrough.renderer.models.shipped.glb import Node
from seethrough.renderer.models.vehicles.jeep import pieces_in_metres
from seethrough.renderer.models.vehicles.jeep_engine import axle, engine_parts, springs
from seethrough.renderer.scene.transforms import translation

HIDDEN = frozenset(
    "radiator,battery,gearbox,front axle,rear axle,front springs,rear springs,front shaft,"
    "rear shaft,exhaust,fuel tank,steering".split(",")
)
TOO_SMALL = ("head bolts", "oil cap")
FRONT = 1.02  # of the axles, before and behind the middle
WHEELS = {
    "front left wheel": (-0.63, -FRONT, -1), "front right wheel": (0.63, -FRONT, 1),
    "rear left wheel": (-0.63, FRONT, -1), "rear right wheel": (0.63, FRONT, 1),
}  # fmt: skip


def jeep_file() -> tuple[list[Node], dict[str, Shape]]:
    """Nodes and shapes; what stands several times is one mesh."""
    pieces = pieces_in_metres()
    axle_y = 0.37
    wheel = pieces.pop("front right wheel").at(-0.63, -axle_y, FRONT)
    for name in ("front left wheel", "rear left wheel", "rear right wheel", "spare wheel",
                 "front axle", "rear axle", "front springs", "rear springs", "engine",
                 "passenger's seat"):  # fmt: skip
        del pieces[name]
    seat = pieces.pop("driver's seat").at(0.33)
    shapes = {**engine_parts(), **pieces}
    nodes = [Node(name, name, extras=_tags(name)) for name in shapes]
    shapes |= {"wheel": wheel, "seat": seat, "axle": axle(0.0, 1), "springs": springs(0.0)}
    turn = np.diag([1.0, 1.0, -1.0, 1.0])
    for name, (x, z, side) in WHEELS.items():
        place = translation(x, axle_y, z) @ np.diag([float(side), 1.0, 1.0, 1.0])
        nodes.append(Node(name, "wheel", place))
    spare = np.array([[0.0, 0, -1, 0.25], [0, 1, 0, 0.85], [1, 0, 0, 1.66], [0, 0, 0, 1]])
    nodes += [
        Node("spare wheel", "wheel", spare),
        Node("driver's seat", "seat", translation(-0.33, 0, 0)),
        Node("passenger's seat", "seat", translation(0.33, 0, 0)),
        Node("front axle", "axle", translation(0, 0, -FRONT), _tags("front axle")),
        Node("rear axle", "axle", translation(0, 0, FRONT) @ turn, _tags("rear axle")),
        Node("front springs", "springs", translation(0, 0, -FRONT), _tags("front springs")),
        Node("rear springs", "springs", translation(0, 0, FRONT), _tags("rear springs")),
    ]
    return nodes, shapes


def _tags(name: str) -> dict[str, object]:
    part = name in engine_parts()
    tags: dict[str, object] = {"group": "engine"} if part else {}
    if name in HIDDEN or (part and name not in TOO_SMALL):
        tags["target"] = True
    return tags
