"""Dynamic transparency: occluders turn transparent where a target lies behind them (Elmqvist2009
§III–V)."""

from __future__ import annotations

from dataclasses import dataclass

from seethrough.renderer.declared import check, key
from seethrough.renderer.techniques.base import Parameters

MASKS = ("outline", "ring", "circle", "ellipse", "oriented-ellipse", "hull")
MODES = ("passive", "active")
GRANULARITIES = ("pixel", "surface", "object", "region")
COMBINES = ("product", "min")
MODELS = ("multiplicative", "additive")
ORDERS = ("planes", "polygons", "centers")

_OWNER = "dynamic transparency"


@dataclass(frozen=True)
class DynamicTransparency(Parameters):
    """What the technique may vary. The paper prints 128 × 128 cells and no other value: the
    defaults are ours, chosen by `seethrough bench accuracy` (benchmarks/README.md has the table
    and says how each follows from it).

    In front of a target an occluder keeps the opacity `alpha_target`. At the border of the mask
    its opacity jumps to the lower `alpha_edge`, and rises from there to 1 over `width` pixels of
    the window, so that the border is clearest (Elmqvist2009 §V-D). `mask` is the shape of the part
    that has `alpha_target`: the target's own outline; the same by the paper's ring growth on
    `ring_size` × `ring_size` cells; a circle, an upright or an object-aligned ellipse about it; or
    its convex hull.

    `granularity` is what turns transparent as a whole (§III-D): the pixel, the surface (triangle),
    the object, or the region (group); for the last three, whatever lies in front of the part of a
    mask with `alpha_target` turns to `alpha_target`. In `active` mode masks only work within
    `radius` of `pointer`, fading over `softness` more (§III-E; all in view units, no pointer: no
    light). At most `layers` layers of occluders turn transparent at a pixel, from the front
    (§III-F). `penetrable_within` keeps everything impenetrable that is farther from the viewer,
    in world units (§III-C.3).

    Where masks line up, their opacities multiply, or the least one counts (`combine`). With
    `min_transmittance` the opacities in front of a target fall further where many layers would
    leave less than this share of the light through. `model` says how transparency adds up along a
    line of sight (§III-A). Objects are drawn in the order that planes between their boxes say, and
    what no plane separates is sorted by pixel if it makes up more than the share `doubt` of the
    picture. Else a target goes before what is none, so that nothing transparent hides it; two such
    targets are sorted by pixel in any case; the rest goes by its centres. With `order` "polygons",
    convex objects that reach into one another are cut along each other and drawn polygon by
    polygon, quicker as long as they stand still. With "centers", everything is drawn by the view
    depth of the groups' centres, as in the paper (§V-B). With `exact`, every pixel is sorted by
    itself: slower, no approximation.
    """

    alpha_target: float = key(
        0.3, "opacity that an occluder keeps in front of a target", low=0, high=1
    )
    alpha_edge: float = key(0.1, "opacity right outside the border of the mask", low=0, high=1)
    width: float = key(
        10.0, "over how far opacity rises from the border of the mask back to 1",
        "pixels of the window", low=0, high=1000,
    )  # fmt: skip
    mask: str = key("outline", "shape of the part that has `alpha_target`", choices=MASKS)
    granularity: str = key("pixel", "what turns transparent as a whole", choices=GRANULARITIES)
    mode: str = key(
        "passive", "passive: masks work everywhere; active: only about the pointer", choices=MODES
    )
    pointer: tuple[float, float] | None = key(
        None, "where active masks work before the pointer has moved", "heights of the view",
        low=-1e6, high=1e6, point=True,
    )  # fmt: skip
    radius: float = key(
        0.2, "how far about the pointer active masks work", "heights of the view", low=0, high=100
    )
    softness: float = key(
        0.05, "over how far beyond `radius` they fade", "heights of the view", low=0, high=100
    )
    layers: int | None = key(
        None, "most layers of occluders that turn transparent at a pixel, from the front",
        low=0, high=10_000,
    )  # fmt: skip
    penetrable_within: float | None = key(
        None, "what is farther away than this stays opaque", "world units", low=0, high=1e12
    )
    combine: str = key(
        "product", "where masks line up: opacities multiply, or the least counts", choices=COMBINES
    )
    min_transmittance: float = key(
        0.0, "share of the light that many layers in front of a target let through at least",
        low=0, high=0.99,
    )  # fmt: skip
    model: str = key(
        "multiplicative", "how transparency adds up along a line of sight", choices=MODELS
    )
    ring_size: int = key(
        128, 'cells along each side of the grid that mask "ring" grows on', low=2, high=4096
    )
    order: str = key("planes", "how translucent objects are ordered", choices=ORDERS)
    doubt: float = key(
        0.05, "share of the picture whose order is in doubt above which it is sorted by pixel, "
        "else by centres", low=0, high=1,
    )  # fmt: skip
    exact: bool = key(False, "sort every pixel by itself: slower, no approximation")

    def __post_init__(self) -> None:
        check(self, _OWNER)

    @property
    def per_pixel_only(self) -> bool:
        """Whether only sorting every pixel by itself can draw this: no order of objects does."""
        return (
            self.exact
            or self.granularity != "pixel"
            or self.layers is not None
            or self.model != "multiplicative"
        )


def by_masks(technique: Parameters) -> DynamicTransparency:
    """The parameters of a technique whose painter is MASKS: it draws this one and no other.

    Raises TypeError for another's.
    """
    if not isinstance(technique, DynamicTransparency):
        raise TypeError(f"{technique.technique.name} has no masks: expected another painter")
    return technique
