"""The printed numbers: each knows how far it was rounded."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.resources import files

from seethrough.analysis.load.files import table_in


@dataclass(frozen=True, slots=True)
class Printed:
    """A number as printed; the true value lies in [low, high]."""

    text: str

    @property
    def value(self) -> float:
        return float(self.text)

    @property
    def half(self) -> float:
        """Half a unit of the last printed digit."""
        _, _, decimals = self.text.partition(".")
        return 0.5 * 10.0 ** -len(decimals)

    @property
    def low(self) -> float:
        return self.value - self.half

    @property
    def high(self) -> float:
        return self.value + self.half

    def fits(self, value: float, halves: bool = True) -> bool:
        """Whether `value` prints as this; 1e-9 forgives the last bits of a half.

        A value on a half prints either way, by the rule of rounding; with `halves` false it does
        only if this ends in an even digit, as rounding to even has it.
        """
        gap, even = abs(value - self.value), self.text[-1] in "02468"
        forgiven = 1e-9 if halves or even else -1e-9
        return gap <= self.half + forgiven


@dataclass(frozen=True, slots=True)
class Moments:
    """A printed mean with its s.d.; `assumed`: the s.d. is a reading of a damaged scan."""

    mean: Printed
    sd: Printed
    assumed: bool = False


@dataclass(frozen=True, slots=True)
class Claim:
    """A printed p: `< .05` or a number."""

    text: str

    @property
    def bound(self) -> bool:
        return self.text.startswith(("<", ">"))

    def allows(self, low: float, high: float) -> bool:
        """Whether some p in [low, high] is printed like this."""
        if self.bound:
            return low < float(self.text.lstrip("< "))
        printed = Printed(self.text)
        return low <= printed.high and high >= printed.low


@dataclass(frozen=True, slots=True)
class PublishedMeasure:
    """A row of the paper's results with F(1, n − 1)."""

    name: str
    label: str
    unit: str
    standard: Moments
    dynamic: Moments
    f: Printed
    p: Claim


@dataclass(frozen=True, slots=True)
class Single:
    """An item asked once, on a scale of whole numbers from 0 to `highest`."""

    name: str
    label: str
    highest: int
    moments: Moments


@dataclass(frozen=True, slots=True)
class Published:
    """Everything that is read from published.toml; `margins` are ours, of the study file."""

    participants: int
    trials: int
    per_cell: int
    tasks: tuple[str, ...]
    measures: tuple[PublishedMeasure, ...]
    correct: tuple[Moments, Moments]
    correct_p: Claim
    rating: tuple[Moments, Moments]
    rating_p: Claim
    rating_items: int
    rating_highest: int
    single: tuple[Single, ...]
    margins: Mapping[str, float]

    def measure(self, name: str) -> PublishedMeasure:
        return next(m for m in self.measures if m.name == name)


def load_published() -> Published:
    """Read the numbers, which travel with the package (data/published/ has the same file)."""
    file = files("seethrough.analysis.published") / "published.toml"
    raw = tomllib.loads(file.read_text(encoding="utf-8"))
    study, correct, rating = raw["study"], raw["correct_T2"], raw["rating"]
    return Published(
        study["participants"],
        study["trials"],
        study["trials_per_task_and_condition"],
        tuple(study["tasks"]),
        tuple(_measure(m) for m in raw["measure"]),
        (_moments(correct["standard"]), _moments(correct["dynamic"])),
        Claim(correct["p"]),
        (_moments(rating["standard"]), _moments(rating["dynamic"])),
        Claim(rating["p"]),
        rating["items"],
        rating["highest"],
        tuple(Single(s["name"], s["label"], s["highest"], _moments(s)) for s in raw["single"]),
        margins(),
    )


def margins() -> dict[str, float]:
    """What the shipped study file of this design declares; the paper itself declares none."""
    study = tomllib.loads(
        (files("seethrough.configs") / "published.toml").read_text(encoding="utf-8")
    )
    return dict(study["analysis"]["margins"])


def _moments(raw: Mapping[str, object]) -> Moments:
    mean, sd = Printed(str(raw["mean"])), Printed(str(raw["sd"]))
    return Moments(mean, sd, bool(raw.get("assumed", False)))


def _measure(raw: dict[str, object]) -> PublishedMeasure:
    return PublishedMeasure(
        str(raw["name"]),
        str(raw["label"]),
        str(raw["unit"]),
        _moments(table_in(raw, "standard")),
        _moments(table_in(raw, "dynamic")),
        Printed(str(raw["F"])),
        Claim(str(raw["p"])),
    )
