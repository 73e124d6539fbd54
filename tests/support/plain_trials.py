"""Trials played by simulated participants in plain worlds, with looks that need no renderer."""

import numpy as np

from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.suites.plain_looks import plain_look
from seethrough.renderer.scene import geometry
from seethrough.tasks.catalog import TASKS, setting
from seethrough.tasks.worlds.building.building import count_building, unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

ASPECT = 4 / 3
_MESHES = {
    "ball": geometry.sphere(0.8),
    "block": geometry.box(1, 1.5, 2),
    "cone": geometry.cone(0.5, 1.5),
    "drum": geometry.cylinder(0.7, 1),
}
MODELS = {name: (lambda mesh=mesh: mesh) for name, mesh in _MESHES.items()}


def begun(name, seed):
    """A trial's first state; buildings are furnished with plain shapes, which are quick to make."""
    rng, task = np.random.default_rng(seed), TASKS[name]
    if "abstract" in task.worlds:
        given = setting(task)
        return task.begin(task.make_scene(rng, given), given, ASPECT)
    make = unique_building if name == "unique" else count_building
    building = make(rng, BuildingParameters(), MODELS)
    return task.begin(building, setting(task, building.parameters), ASPECT)


def sight(view, shown):
    """All that `shown` (n,) marks and that lies in the view, large and clear; no occlusion."""
    return plain_look(view, ASPECT, shown)


def play(name, seed=1, shown=lambda scene: np.ones(len(scene.objects), bool), most=4000, **more):
    """One trial: (outcome, seconds, events, participant)."""
    task = TASKS[name]
    state = begun(name, seed)
    participant = SimulatedParticipant(np.random.default_rng([seed, 100]), **more)
    participant.begin_trial(name, 0.0)
    now, events = 0.0, []
    while task.outcome(state) is None and len(events) < most:
        view = task.view(state)
        visible = shown(view.scene)
        batch = participant.events(view, lambda v=view, s=visible: sight(v, s), now, name)
        assert batch and all(e.time >= now - 1e-12 for e in batch)
        for event in batch:
            state = task.on_event(state, event)
        now = max(e.time for e in batch)
        events += batch
    return task.outcome(state), now, events, participant


QUIET = ("slips", "view_changes", "crowding", "people", "trial_noise", "learning", "depth_noise",
         "drift", "motor_noise", "fatigue")  # fmt: skip
