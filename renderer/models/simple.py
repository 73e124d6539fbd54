"""A scene in models of few triangles, for small pictures of it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from seethrough.renderer.look.dressed import dressed
from seethrough.renderer.models import MODELS, proxy
from seethrough.renderer.scene.scene import Object, Scene

SCENES_KEPT = 8


@lru_cache(maxsize=SCENES_KEPT)
def simplified(scene: Scene) -> Scene:
    """The same objects, with the proxy of each model in its place (renderer/models/proxies.py).

    What is no model stays as it is. A tenth of a building's triangles are left; `python -m
    seethrough.benchmarks.sessions.eyes` shows what that does to what a simulated participant
    measures.
    """
    if scene.bare is not None:
        return dressed(simplified(scene.bare), scene.look)
    return replace(scene, objects=tuple(_simple(thing) for thing in scene.objects))


def _simple(thing: Object) -> Object:
    if thing.kind in MODELS and MODELS[thing.kind]() is thing.mesh:
        return replace(thing, mesh=proxy(thing.kind))
    return thing
