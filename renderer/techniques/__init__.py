"""Occlusion-management techniques: one package each, whose TECHNIQUE describes itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields

from seethrough import registry
from seethrough.renderer.techniques.base import Parameters


def named(name: str, tables: Mapping[str, Parameters] | None = None) -> Parameters:
    """What draws a level that uses this technique: its parameters, which know their technique.

    `tables` has the parameters of techniques by their names; those that it lacks are the defaults.
    Raises KeyError where there is no such technique.
    """
    if tables and name in tables:
        return tables[name]
    made: Parameters = registry.get("technique", name).Parameters()
    return made


def changed(p: Parameters, **values: object) -> Parameters:
    """The same technique with some of its parameters changed. Raises ValueError, TypeError."""
    return type(p)(**{f.name: getattr(p, f.name) for f in fields(p)} | values)
