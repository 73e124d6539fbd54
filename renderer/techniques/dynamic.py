"""Dynamic transparency: occluders turn transparent where a target lies behind them (004 §III–V)."""

from __future__ import annotations

from dataclasses import dataclass

from renderer import checks

MASKS = ("outline", "ring", "circle", "ellipse", "oriented-ellipse", "hull")
MODES = ("passive", "active")
GRANULARITIES = ("pixel", "surface", "object", "region")
COMBINES = ("product", "min")
MODELS = ("multiplicative", "additive")
ORDERS = ("planes", "polygons", "centers")

_OWNER = "dynamic transparency"


@dataclass(frozen=True)
class DynamicTransparency:
    """What the technique may vary. The paper prints 128 × 128 cells and no other value: the
    defaults are ours, chosen by `seethrough bench accuracy` (benchmarks/README.md has the table
    and says how each follows from it).

    In front of a target an occluder keeps the opacity `alpha_target`. At the border of the mask
    its opacity jumps to the lower `alpha_edge`, and rises from there to 1 over `width` pixels of
    the window, so that the border is clearest (004 §V-D). `mask` is the shape of the part that
    has `alpha_target`: the target's own outline; the same by the paper's ring growth on
    `ring_size` × `ring_size` cells; a circle, an upright or an object-aligned ellipse about it;
    or its convex hull.

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

    alpha_target: float = 0.3
    alpha_edge: float = 0.1
    width: float = 10.0
    mask: str = "outline"
    granularity: str = "pixel"
    mode: str = "passive"
    pointer: tuple[float, float] | None = None
    radius: float = 0.2
    softness: float = 0.05
    layers: int | None = None
    penetrable_within: float | None = None
    combine: str = "product"
    min_transmittance: float = 0.0
    model: str = "multiplicative"
    ring_size: int = 128
    order: str = "planes"
    doubt: float = 0.05
    exact: bool = False

    def __post_init__(self) -> None:
        checks.number(_OWNER, "alpha_target", self.alpha_target, 0, 1)
        checks.number(_OWNER, "alpha_edge", self.alpha_edge, 0, 1)
        checks.number(_OWNER, "width", self.width, 0, 1000)
        checks.choice(_OWNER, "mask", self.mask, MASKS)
        checks.choice(_OWNER, "granularity", self.granularity, GRANULARITIES)
        checks.choice(_OWNER, "mode", self.mode, MODES)
        checks.number(_OWNER, "radius", self.radius, 0, 100)
        checks.number(_OWNER, "softness", self.softness, 0, 100)
        if self.pointer is not None:
            if not isinstance(self.pointer, tuple) or len(self.pointer) != 2:
                raise ValueError(f"{_OWNER}: pointer = {self.pointer!r}, expected two numbers")
            for name, value in zip(("pointer x", "pointer y"), self.pointer, strict=True):
                checks.number(_OWNER, name, value, -1e6, 1e6)
        if self.layers is not None:
            checks.whole(_OWNER, "layers", self.layers, 0, 10_000)
        if self.penetrable_within is not None:
            checks.number(_OWNER, "penetrable_within", self.penetrable_within, 0, 1e12)
        checks.choice(_OWNER, "combine", self.combine, COMBINES)
        checks.number(_OWNER, "min_transmittance", self.min_transmittance, 0, 0.99)
        checks.choice(_OWNER, "model", self.model, MODELS)
        checks.whole(_OWNER, "ring_size", self.ring_size, 2, 4096)
        checks.choice(_OWNER, "order", self.order, ORDERS)
        checks.number(_OWNER, "doubt", self.doubt, 0, 1)

    @property
    def per_pixel_only(self) -> bool:
        """Whether only sorting every pixel by itself can draw this: no order of objects does."""
        return (
            self.exact
            or self.granularity != "pixel"
            or self.layers is not None
            or self.model != "multiplicative"
        )
