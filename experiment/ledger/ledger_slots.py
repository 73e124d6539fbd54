"""Which slot comes next: pure, so that a model can be tested against it.

A slot is a number from 1; its row of the counterbalanced design is (slot − 1) mod rows. A slot is
held by at most one participant who is live or complete. Slots beyond the target number are handed
out only when every slot up to it is complete, and then by whole rounds of the rows: so completed
rows differ by at most one from the target number on, whoever dropped out on the way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

LIVE, COMPLETE, VOID, SURPLUS = "live", "complete", "void", "surplus"
STALE = "stale"  # how the reason begins that an entry is void for its slot was given away
STATUSES = (LIVE, COMPLETE, VOID, SURPLUS)


@dataclass(frozen=True, slots=True)
class Entry:
    """A participant's line of the ledger.

    `status` is live (reserved, perhaps interrupted), complete, void (left, withdrawn, or stale and
    given to somebody else), or surplus (completed a slot that somebody else holds by now). Times
    are UTC, ISO 8601. `new` tells a fresh reservation from one that goes on.
    """

    slot: int
    participant: str
    status: str
    reserved: str
    changed: str
    why: str = ""
    new: bool = False


@dataclass(frozen=True, slots=True)
class Held:
    """The held slots of a ledger, with status and the time they were last heard of."""

    slots: tuple[int, ...]
    statuses: tuple[str, ...]
    changed: tuple[str, ...]

    def complete(self) -> set[int]:
        """Slots that are complete."""
        return {slot for slot, status in zip(self.slots, self.statuses, strict=True)
                if status == COMPLETE}  # fmt: skip

    def live(self, stale: str) -> set[int]:
        """Slots that are live and were heard of since `stale`."""
        columns = zip(self.slots, self.statuses, self.changed, strict=True)
        return {slot for slot, status, heard in columns if status == LIVE and heard >= stale}


def row_of(slot: int, rows: int) -> int:
    """The slot's row of the design, from 0."""
    return (slot - 1) % rows


def last_open(complete: Collection[int], rows: int, participants: int) -> int:
    """The highest slot that may be handed out now: the target, or the end of the round past it."""
    done = frozenset(complete)
    last, checked = participants, 0
    while all(slot in done for slot in range(checked + 1, last + 1)):
        checked, last = last, (last // rows + 1) * rows
    return last


def next_slot(
    live: Collection[int], complete: Collection[int], rows: int, participants: int
) -> int | None:
    """The lowest free slot of the row with the fewest completed and live slots.

    None where every slot that may be handed out is live or complete.
    """
    held = frozenset(live) | frozenset(complete)
    end = last_open(complete, rows, participants) + 1
    counts = Counter([row_of(slot, rows) for slot in held])
    free = (
        next((slot for slot in range(row + 1, end, rows) if slot not in held), None)
        for row in range(rows)
    )
    firsts = [(counts[row], slot) for row, slot in enumerate(free) if slot is not None]
    return min(firsts)[1] if firsts else None


def stale_before(now: datetime, after: float) -> str:
    """Live entries last heard of before this time are stale (`after` 0: none is).

    A clock that was set back makes nothing stale.
    """
    return stamp(now - timedelta(seconds=after)) if after else ""


def judged(now: datetime, told: Collection[str]) -> datetime:
    """Now, or the middle of the times that a ledger was told if most of those are later.

    A station whose clock was set back makes nobody stale so, and one whose clock is ahead (a
    reservation from 2036) moves nothing.
    """
    return max(now, moment(sorted(told)[(len(told) - 1) // 2])) if told else now


def moment(text: str) -> datetime:
    """The time that a record holds."""
    return datetime.fromisoformat(text)


def stamp(time: datetime) -> str:
    """A time for a record: UTC, ISO 8601, milliseconds."""
    return time.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")


def free_name(names: Collection[str]) -> str:
    """The lowest P01, P02, … that nobody has."""
    lower = {name.lower() for name in names}
    number = 1
    while f"p{number:02d}" in lower:
        number += 1
    return f"P{number:02d}"
