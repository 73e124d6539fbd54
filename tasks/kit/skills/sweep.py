"""Searching with a technique that hands work: it is carried over the view, place by place, and what
shows at any of them is known afterwards.

Only where events change what a technique shows: everybody else sees what there is at once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import acos

import numpy as np

from seethrough.renderer.events import Event, KeyPress, KeyRelease
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.projection import screen_boxes
from seethrough.renderer.scene.visibility import Visibility, better
from seethrough.renderer.techniques.base import Floats, Parameters, Shot
from seethrough.tasks.kit.base import View
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood

PLACES = 3  # along each side of what there is to see [ours]
DEEP = 0.75  # so much of what there is to see is nearer than where one reaches [ours]
TURN, STEP = np.pi / 4, 5.0  # a walker reaches again after turning or going on so far [ours]
HEIGHT = 1000  # of the shot in which one aims: positions are in view units


class Sweep:
    """What a person's hands do with a technique (its parameters) in a trial, in a view so wide for
    its height. `spent` is how many seconds that took by now."""

    def __init__(self, mood: Mood, technique: Parameters, aspect: float) -> None:
        self.spent = 0.0
        self._mood, self._technique = mood, technique
        self._size = (round(aspect * HEIGHT), HEIGHT)
        self._at: Camera | None = None
        self._seen: Visibility | None = None
        self._points: list[Floats] = []
        self._down: set[str] = set()
        self._walks = False

    def events(self, view: View, look: Callable[[], Visibility], now: float) -> list[Event]:
        """What hands do next; nothing once every place was looked at, or while keys are down."""
        self._walks |= view.captured
        if self._down or self._walks != view.captured:  # over a walker's view lies a plan
            return []
        if self._at is None or self._elsewhere(view):
            self._at, self._points = view.camera, self._places(view)
            self._seen = None
        if not view.captured:
            self._seen = look() if self._seen is None else better(self._seen, look())
        hands, shot = Hands(self._mood, now), Shot(view.scene, view.camera, self._size)
        while self._points:
            point = self._points.pop(0)
            gestures = self._technique.technique.reach(self._technique, view.drawn, shot, point)
            # Where the pointer turns the viewer, only what keys and wheel do is left.
            for gesture in gestures:
                if not (view.captured and gesture.event == "pointer"):
                    hands.does(gesture)
            if hands.time > now:
                self.spent += hands.time - now
                return hands.take()
        return []

    def seen(self, look: Callable[[], Visibility]) -> Callable[[], Visibility]:
        """What one knows of the view: the most that was seen of each thing."""
        known = self._seen
        return look if known is None else lambda: known

    def later(self, events: list[Event]) -> list[Event]:
        """What was planned without the time that hands took, at its time."""
        for event in events:
            if isinstance(event, KeyPress):
                self._down.add(event.key)
            elif isinstance(event, KeyRelease):
                self._down.discard(event.key)
        return [replace(event, time=event.time + self.spent) for event in events]

    def _elsewhere(self, view: View) -> bool:
        """Whether this is another view than the one that was searched."""
        assert self._at is not None
        a, b = self._at, view.camera
        if not view.captured:
            return not (np.array_equal(a.eye, b.eye) and np.array_equal(a.rotation, b.rotation))
        turned = acos(min(1.0, max(-1.0, float(a.rotation[:, 2] @ b.rotation[:, 2]))))
        return turned > TURN or float(np.linalg.norm(a.eye - b.eye)) > STEP

    def _places(self, view: View) -> list[Floats]:
        """Points of the world to reach for: on a grid over what is in the view; of a walker, one
        straight ahead."""
        scene, camera = view.scene, view.camera
        boxes = screen_boxes(scene.corners, camera, self._size)
        inside = boxes.inside & ~scene.impenetrable
        if not inside.any():
            return []
        depth = float(np.quantile(camera.depth(scene.centers[inside]), DEEP))
        if depth <= camera.near:
            return []
        if view.captured:
            return [camera.eye + camera.forward * depth]
        low = np.maximum(boxes.extents[inside, :2].min(axis=0), 0)
        high = np.minimum(boxes.extents[inside, 2:].max(axis=0), self._size)
        share = (np.arange(PLACES) + 0.5) / PLACES
        right, up, _ = camera.rotation.T
        lens = camera.lens(HEIGHT)
        return [
            camera.eye + depth * (
                camera.forward
                + right * (low[0] + x * (high[0] - low[0]) - self._size[0] / 2) / lens
                - up * (low[1] + y * (high[1] - low[1]) - HEIGHT / 2) / lens
            )
            for y in share
            for x in share
        ]  # fmt: skip


def sweep_of(mood: Mood, technique: Parameters | None, aspect: float) -> Sweep | None:
    """For a technique that hands work; None for all others."""
    if technique is None or not technique.technique.active(technique):
        return None
    return Sweep(mood, technique, aspect)
