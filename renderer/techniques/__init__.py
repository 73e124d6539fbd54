"""Occlusion-management techniques: one package each, whose TECHNIQUE describes itself."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from seethrough import registry


def named(name: str, tables: Mapping[str, object] | None = None) -> Any:
    """What draws a level that uses this technique: its parameters, which know their technique.

    `tables` has the parameters of techniques by their names; those that it lacks are the defaults.
    Raises KeyError where there is no such technique.
    """
    if tables and name in tables:
        return tables[name]
    return registry.get("technique", name).Parameters()
