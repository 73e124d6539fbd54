"""What code outside may rely on: plug-ins' parts, and data and results of a study.

    from seethrough.api import Basics, Outcome, View, key        # a task of one's own
    from seethrough.api import removal, Shot                     # a technique
    from seethrough import api; api.load("data/").trials         # a notebook

Modules stand here whole: each public name of theirs counts. `VERSION` counts changes that code
outside would notice; what stands here stays, or the number grows. docs/api.md lists all of it,
docs/notebook.md and the guide have worked examples.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from seethrough.experiment.pages import pages
from seethrough.experiment.questions.kit import Asking, OnOnePage, Question, Row, row
from seethrough.renderer import events
from seethrough.renderer.declared import Declares, check, key
from seethrough.renderer.scene import geometry, transforms
from seethrough.renderer.scene.camera import Camera, look_at
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.techniques import layered, pointing, reaching, removal
from seethrough.renderer.techniques.base import Gesture, Parameters, Plain, Shot, Shown, Technique
from seethrough.renderer.techniques.seen import Look, Surfaces
from seethrough.tasks.kit import controls, hud, measure
from seethrough.tasks.kit.base import Basics, Example, Outcome, Setting, Task, View
from seethrough.tasks.kit.entry import NumberEntry
from seethrough.tasks.kit.skills.glance import Glance
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.strategy import Play, Strategy
from seethrough.tasks.kit.world import Place, Viewer, World, WorldParameters, keys, scenes

if TYPE_CHECKING:
    from seethrough.analysis.notebook import Loaded, load, results

__all__ = [
    "VERSION",
    "Asking",
    "Basics",
    "Camera",
    "Declares",
    "Example",
    "Gesture",
    "Glance",
    "Hands",
    "Loaded",
    "Look",
    "Mesh",
    "Mood",
    "NumberEntry",
    "Object",
    "OnOnePage",
    "Outcome",
    "Parameters",
    "Place",
    "Plain",
    "Play",
    "Question",
    "Row",
    "Scene",
    "Setting",
    "Shot",
    "Shown",
    "Strategy",
    "Surfaces",
    "Task",
    "Technique",
    "View",
    "Viewer",
    "World",
    "WorldParameters",
    "check",
    "controls",
    "events",
    "geometry",
    "hud",
    "key",
    "keys",
    "layered",
    "load",
    "look_at",
    "measure",
    "pages",
    "pointing",
    "reaching",
    "removal",
    "results",
    "row",
    "scenes",
    "transforms",
]

VERSION = 3

LATER = ("Loaded", "load", "results")  # statistics take a second to import, plug-ins need none


def __getattr__(name: str) -> object:
    if name not in LATER:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from seethrough.analysis import notebook

    return getattr(notebook, name)


def __dir__() -> list[str]:
    return __all__
