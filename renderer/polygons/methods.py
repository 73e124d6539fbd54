"""Every ordering by name; a method's kernels are loaded when it is asked for."""

from __future__ import annotations

from importlib import import_module

from seethrough.renderer.polygons.polygons import Polygons
from seethrough.renderer.polygons.prepared import Prepared

# Module, and what to ask of it.
METHODS: dict[str, tuple[str, dict[str, str]]] = {
    "distance": ("distance", {}),
    "depth": ("distance", {"metric": "depth"}),
    "axis_tree": ("axis_tree", {}),
    "boxes": ("boxes.boxes", {}),
    "boxes_paper": ("boxes.boxes", {"rule": "paper"}),
    "bsp": ("bsp", {}),
    "bsp_first": ("bsp", {"splitter": "first"}),
    "bsp_fewest": ("bsp", {"splitter": "fewest"}),
    "feudal": ("feudal.feudal", {}),
    "feudal_dynamic": ("feudal.feudal", {"version": "dynamic"}),
}


CUTTING = ("bsp", "feudal.feudal")


def prepare(name: str, polygons: Polygons, most: int | None = None) -> Prepared:
    """Polygons prepared by a method; those that cut make `most` pieces at most.

    Raises ValueError for a name there isn't, and beyond that bound.
    """
    if name not in METHODS:
        raise ValueError(f"order = {name!r}, expected one of {', '.join(METHODS)}")
    module, options = METHODS[name]
    bound = {} if most is None or module not in CUTTING else {"most": most}
    prepared: Prepared = import_module(f"seethrough.renderer.polygons.{module}").prepare(
        polygons, **options, **bound
    )
    return prepared
