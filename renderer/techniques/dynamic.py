"""Dynamic transparency: occluders turn transparent where a target lies behind them (004 §V)."""

from __future__ import annotations

from dataclasses import dataclass

from renderer import checks

MASKS = ("outline",)


@dataclass(frozen=True)
class DynamicTransparency:
    """Passive, per pixel. Opacities in [0, 1]; `width` in pixels of the window (004 §V-D).

    In front of a target an occluder keeps the opacity `alpha_target`. At the target's outline its
    opacity jumps to the lower `alpha_edge`, and rises from there to 1 over `width` pixels, so that
    the border is clearest. The paper prints no values: these are ours.
    """

    alpha_target: float = 0.3
    alpha_edge: float = 0.1
    width: float = 10.0
    mask: str = "outline"

    def __post_init__(self) -> None:
        owner = "dynamic transparency"
        checks.number(owner, "alpha_target", self.alpha_target, 0, 1)
        checks.number(owner, "alpha_edge", self.alpha_edge, 0, 1)
        checks.number(owner, "width", self.width, 0, 1000)
        checks.choice(owner, "mask", self.mask, MASKS)
