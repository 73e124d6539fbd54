"""In which ways each technique is measured: as it is, and with options that cost something else."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from seethrough.experiment.gallery.gallery_techniques import placed
from seethrough.renderer.techniques import changed
from seethrough.renderer.techniques.base import Parameters, Shot
from seethrough.renderer.techniques.pointing import place_of
from seethrough.tasks.kit.gestures import after

# What a frame may cost, over the standard one: (must, aim).
COSTS = {
    "cutaway": (2.0, 1.5), "cutaway, cap none": (1.5, 1.25),
    "breakaway": (2.0, 1.5), "breakaway, cap none": (1.5, 1.25),
    "lens": (2.0, 1.5), "lens, cap none": (1.5, 1.25),
    "dig": (2.0, 1.5), "dig, cap none": (1.5, 1.25),
    "adaptive_cutaway": (3.0, 2.0),
    "constant": (4.5, 2.5), "constant, all surfaces, 4 peels": (10.0, 6.0),
    "see_through": (3.0, 2.0), "importance": (3.0, 2.0), "fade": (3.0, 2.0),
    "view_dependent": (5.0, 3.0),
    "blueprint": (6.5, 5.0), "blueprint, all surfaces": (9.0, 5.0),
    "balloon": (2.0, 1.3),
    "idle": (1.1, 1.02),
}  # fmt: skip
PEELS = (1, 2, 4, 8)


@dataclass(frozen=True)
class Way:
    """Parameters with which a technique is drawn, and those of what would be exact."""

    p: Parameters
    exact: Parameters

    def state(self, shot: Shot) -> object:
        """Hands reach for the target nearest to the middle of the view."""
        p, scene = self.p, shot.scene
        begun = p.technique.begin(p)
        places = {int(k): place_of(shot, scene.centers[k]) for k in np.nonzero(scene.targets)[0]}
        away = {
            k: np.hypot(place[0] - shot.aspect / 2, place[1] - 0.5)
            for k, place in places.items() if place is not None
        }  # fmt: skip
        if not away or not p.technique.active(p):
            return begun
        nearest = min(away, key=lambda k: (away[k], k))
        return after(p, begun, shot, p.technique.reach(p, begun, shot, scene.centers[nearest]))


def ways_of(name: str, shot: Shot) -> dict[str, Way]:
    """A technique as it is, and as the table asks for it besides."""
    reach = float(np.linalg.norm(shot.camera.eye - shot.scene.centers.mean(axis=0)))
    p, _ = placed(name, shot, max(reach, 1.0))
    exact = p.technique.exactly(p)
    found = {name: Way(p, exact)}
    known = {field.name for field in fields(p)}
    if exact != p:
        found[f"{name}, exact"] = Way(exact, exact)
    if "cap" in known and name != "adaptive_cutaway":
        bare = changed(p, cap="none")
        found[f"{name}, cap none"] = Way(bare, bare)
    if name == "constant":
        for count in PEELS:
            found[f"constant, {count} peels"] = Way(changed(p, layers=count), p)
        every = changed(p, surfaces="all")
        found["constant, all surfaces, 4 peels"] = Way(changed(every, layers=4), every)
    if name == "blueprint":
        every = changed(p, surfaces="all")
        found["blueprint, all surfaces"] = Way(every, every)
    return found
