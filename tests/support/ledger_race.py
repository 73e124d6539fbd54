"""A race for places in groups: 8 processes take 1,000 slots each, on SQLite and PostgreSQL.

    .venv/bin/python tests/support/ledger_race.py [EACH]

Equal groups without drop-outs, and unequal ones of which every tenth is replaced. No place may be
given twice, quotas are exact when all have come, and of equal groups none is ever more than one
ahead where nobody leaves. Prints a line for each; exit status 1 where one does not hold.
"""

from __future__ import annotations

import json
import multiprocessing
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from datetime import UTC, datetime
from multiprocessing.synchronize import Barrier
from pathlib import Path

from postgres import Postgres

from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan
from seethrough.experiment.ledger.ledger_slots import Entry, place_of

STATIONS = 8
NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
DESIGNS = {"equal": ((1, 1, 1, 1), 0), "unequal": ((12, 5, 3), 10)}  # every so many are replaced


def plan_of(people: Sequence[int]) -> Plan:
    """A study of these groups."""
    groups = [
        {"rows": 7, "people": n, "levels": {"g": str(g)}, "measured": {}}
        for g, n in enumerate(people)
    ]
    return Plan("race", "d" * 64, 7, sum(people), 86_400.0, {"groups": groups})


def station(number: int, data: str, url: str, people: Sequence[int], each: int, dropped: int,
            together: Barrier) -> None:  # fmt: skip
    """Take places one after the other, as the other stations do."""
    with Ledger.open(Path(data), url, plan_of(people), NOW) as ledger:
        together.wait(60)
        for i in range(each):
            ledger.reserve(f"S{number}-{i}", NOW)
            if dropped and i % dropped == 0:
                ledger.void(f"S{number}-{i}", "left", NOW)
                ledger.reserve(f"S{number}-{i}b", NOW)
            time.sleep(0.002)  # a station does something else in between, and lets others in


def race(url: str, people: Sequence[int], each: int, dropped: int) -> tuple[list[Entry], bool]:
    """Every entry in the order of reservation, and whether no place is left."""
    with tempfile.TemporaryDirectory() as data:
        forks = multiprocessing.get_context("fork")
        together = forks.Barrier(STATIONS)
        stations = [
            forks.Process(target=station, args=(n, data, url, people, each, dropped, together))
            for n in range(STATIONS)
        ]
        for process in stations:
            process.start()
        for process in stations:
            process.join()
        assert not any(process.exitcode for process in stations)
        with Ledger.open(Path(data), url, plan_of(people), NOW) as ledger:
            return list(ledger.entries()), ledger.upcoming(NOW) is None


def faults(entries: Sequence[Entry], people: Sequence[int], dropped: int) -> list[str]:
    """What of the promise did not hold."""
    found = []
    live = [place_of(e.slot, len(people)) for e in entries if e.status == "live"]
    if len(set(live)) < len(live):
        found.append(f"{len(live) - len(set(live))} places given twice")
    counts = Counter(group for group, _ in live)
    if [counts[g] for g in range(len(people))] != list(people):
        found.append(f"{dict(counts)} people in groups of {list(people)}")
    if len(set(people)) == 1 and not dropped:
        here = dict.fromkeys(range(len(people)), 0)
        apart = 0
        for entry in entries:
            here[place_of(entry.slot, len(people))[0]] += 1
            apart = max(apart, max(here.values()) - min(here.values()))
        if apart > 1:
            found.append(f"groups were {apart} apart on the way")
    return found


def main(each: int = 1000) -> int:
    """Every race; 0 where all of it held."""
    failed = 0
    for database in ("sqlite", "postgresql"):
        for name, (shares, dropped) in DESIGNS.items():
            people = [STATIONS * each * s // sum(shares) for s in shares]
            server: AbstractContextManager[Postgres | None] = (
                Postgres() if database == "postgresql" else nullcontext()
            )
            began = time.monotonic()
            with server as running:
                entries, full = race("" if running is None else running.url, people, each, dropped)
            wrong = faults(entries, people, dropped) + ([] if full else ["places were left"])
            failed += bool(wrong)
            said = json.dumps({"database": database, "groups": name, "people": people,
                               "replaced": len(entries) - sum(people),
                               "seconds": round(time.monotonic() - began, 1)})  # fmt: skip
            print(f"{said}: {'; '.join(wrong) or 'held'}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
