"""Which slot comes next: pure, so that a model can be tested against it.

A slot is a number from 1. Where there are groups they take turns: slot s is number
⌊(s − 1) / groups⌋ + 1 of group (s − 1) mod groups; the number's row of the counterbalanced design
is (number − 1) mod rows. A slot is held by at most one participant who is live or complete. Slots
beyond the target number are handed out only when every slot up to it is complete, and then by whole
rounds of the rows: so completed rows differ by at most one from the target number on, whoever
dropped out on the way.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta

LIVE, COMPLETE, VOID, SURPLUS = "live", "complete", "void", "surplus"
STALE = "stale"  # how the reason begins that an entry is void for its slot was given away


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


@dataclass(frozen=True, slots=True)
class Places:
    """A group's part of the design: its rows, how many people are wanted, the levels that they have
    or get, and those of them that they bring along."""

    rows: int
    people: int
    levels: Mapping[str, str] = field(default_factory=dict)
    measured: Mapping[str, str] = field(default_factory=dict)


def place_of(slot: int, groups: int) -> tuple[int, int]:
    """(group from 0, number in it from 1) of a slot."""
    return (slot - 1) % groups, (slot - 1) // groups + 1


def row_of(number: int, rows: int) -> int:
    """A number's row of the design, from 0."""
    return (number - 1) % rows


def last_open(complete: Collection[int], rows: int, participants: int) -> int:
    """The highest slot that may be handed out now: the target, or the end of the round past it."""
    done = frozenset(complete)
    last, checked = participants, 0
    while all(slot in done for slot in range(checked + 1, last + 1)):
        checked, last = last, (last // rows + 1) * rows
    return last


def next_slot(
    live: Collection[int],
    complete: Collection[int],
    groups: Sequence[Places],
    brings: Mapping[str, str] | None = None,
) -> int | None:
    """The slot of the next person: of the group that has least of its places taken, its next.

    `brings` are the levels that the person brings along. Beyond its quota a group has places only
    once every group has all that it needs. None where every slot that may be handed out is live or
    complete.
    """
    taken: list[tuple[set[int], set[int]]] = [(set(), set()) for _ in groups]
    for kind, slots in enumerate((live, complete)):
        for slot in slots:
            of, place = place_of(slot, len(groups))
            taken[of][kind].add(place)
    whole = all(done.issuperset(range(1, g.people + 1))
                for (_, done), g in zip(taken, groups, strict=True))  # fmt: skip
    found = []
    for which, (group, (here, done)) in enumerate(zip(groups, taken, strict=True)):
        if any(group.measured[k] != v for k, v in (brings or {}).items() if k in group.measured):
            continue
        end = last_open(done, group.rows, group.people) if whole else group.people
        number = _next_number(here | done, group.rows, end + 1)
        if number is not None:
            share = len(here | done) / max(group.people, 1)
            found.append((share, which, (number - 1) * len(groups) + which + 1))
    return min(found)[2] if found else None


def _next_number(held: Collection[int], rows: int, end: int) -> int | None:
    """The lowest free number of the row with the fewest held ones."""
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
