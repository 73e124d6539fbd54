"""Which slot comes next: pure, so that a model can be tested against it.

A slot is a number from 1; its row of the counterbalanced design is (slot − 1) mod rows. A slot is
held by at most one participant who is live or complete. Slots beyond the target number are handed
out only when every slot up to it is complete, and then by whole rounds of the rows: so completed
rows differ by at most one from the target number on, whoever dropped out on the way.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from datetime import UTC, datetime

LIVE, COMPLETE, VOID, SURPLUS = "live", "complete", "void", "surplus"
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
    counts = [0] * rows
    for slot in held:
        counts[row_of(slot, rows)] += 1
    free = (s for s in range(1, last_open(complete, rows, participants) + 1) if s not in held)
    return min(free, key=lambda slot: (counts[row_of(slot, rows)], slot), default=None)


def is_stale(entry: Entry, now: datetime, after: float) -> bool:
    """Whether a live entry was not heard of for over `after` seconds (0: entries never go stale).

    A clock that was set back makes nothing stale.
    """
    if entry.status != LIVE or not after:
        return False
    return (now - moment(entry.changed)).total_seconds() > after


def moment(text: str) -> datetime:
    """The time that a record holds."""
    return datetime.fromisoformat(text)


def stamp(time: datetime) -> str:
    """A time for a record: UTC, ISO 8601, milliseconds."""
    return time.astimezone(UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
