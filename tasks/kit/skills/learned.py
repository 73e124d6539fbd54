"""What a person has learned about looks of late: shares of what was tried that came true.

Nothing here knows what a look was drawn with. Who has met pictures that show much expects much of
the next ones, until they show less.
"""

from __future__ import annotations

from dataclasses import dataclass, field

LASTING = 8.0  # cases that what was learned before a trial counts for in it, at most [ours]


@dataclass
class Share:
    """How often something came true: `expected` of `weight` cases before anything was tried."""

    expected: float
    weight: float
    true: float = 0.0
    cases: float = 0.0

    @property
    def mean(self) -> float:
        """What is expected now."""
        return (self.expected * self.weight + self.true) / (self.weight + self.cases)

    def add(self, true: float, cases: float) -> None:
        """`true` of so many more cases came true."""
        self.true += true
        self.cases += cases

    def fade(self) -> None:
        """A new trial: what was met before counts for `LASTING` cases at most."""
        if self.cases > LASTING:
            self.true, self.cases = self.true * LASTING / self.cases, LASTING


@dataclass
class Learned:
    """A person's shares at one task, by what they are about."""

    shares: dict[str, Share] = field(default_factory=dict)

    def share(self, about: str, expected: float, weight: float) -> Share:
        """The share of that name; as `expected` where nothing has been learned yet."""
        return self.shares.setdefault(about, Share(expected, weight))

    def begin(self) -> None:
        """A new trial begins."""
        for share in self.shares.values():
            share.fade()
