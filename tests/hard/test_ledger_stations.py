"""Many stations at one ledger, on SQLite and on a real PostgreSQL: no slot is given twice."""

import json
import subprocess
import sys
from collections import Counter
from datetime import UTC, datetime

import pytest
from postgres import Postgres

from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan
from seethrough.experiment.ledger.ledger_slots import place_of

STATIONS, SLOTS = 8, 1000
ROWS = 7  # does not divide the number of slots: the rows may differ by one, and must not by two
PLAN = Plan("many", "d" * 64, ROWS, SLOTS, 86_400.0, {})
NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)

# Forks the stations, which wait for each other and then take slots one after the other.
LAUNCHER = f"""
import json, multiprocessing, sys, time
from datetime import datetime, UTC
from pathlib import Path
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan
from seethrough.experiment.ledger.ledger_slots import place_of

STATIONS, EACH = {STATIONS}, {SLOTS // STATIONS}
PLAN = Plan("many", "d" * 64, {ROWS}, {SLOTS}, 86_400.0, json.loads(sys.argv[3]))
DROPPED = int(sys.argv[4])  # every so many leave at once, and somebody else comes
NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)

def station(number, data, url, together):
    with Ledger.open(Path(data), url, PLAN, NOW) as ledger:
        together.wait(60)
        slots = []
        for i in range(EACH):
            slots.append(ledger.reserve(f"S{{number}}-{{i}}", NOW).slot)
            if DROPPED and i % DROPPED == 0:
                ledger.void(f"S{{number}}-{{i}}", "left", NOW)
                slots[-1] = ledger.reserve(f"S{{number}}-{{i}}b", NOW).slot
            time.sleep(0.002)  # a station does something else in between, and lets others in
        return slots

def child(number, data, url, together, results):
    results.put(station(number, data, url, together))

forks = multiprocessing.get_context("fork")
together, results = forks.Barrier(STATIONS), forks.Queue()
for number in range(STATIONS):
    forks.Process(target=child, args=(number, *sys.argv[1:3], together, results)).start()
print(json.dumps([results.get(timeout=100) for _ in range(STATIONS)]))
"""


@pytest.fixture(params=["sqlite", "postgresql"])
def url(request):
    if request.param == "sqlite":
        yield ""
    else:
        with Postgres() as server:
            yield server.url


def test_eight_stations_take_a_thousand_slots_none_twice(url, tmp_path):
    command = [sys.executable, "-c", LAUNCHER, tmp_path, url, "{}", "0"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    stations = json.loads(run.stdout)
    slots = [slot for taken in stations for slot in taken]
    assert sorted(slots) == list(range(1, SLOTS + 1))
    # Slots of a station rise, and stations took turns: had each had its slots by itself, the owner
    # would change seven times from the first slot to the last.
    assert all(taken == sorted(taken) for taken in stations)
    owner = {slot: number for number, taken in enumerate(stations) for slot in taken}
    changes = sum(owner[slot] != owner[slot + 1] for slot in range(1, SLOTS))
    assert changes > 10 * STATIONS
    with Ledger.open(tmp_path, url, PLAN, NOW) as ledger:
        entries = ledger.entries()
    assert sorted(e.slot for e in entries) == sorted(slots)
    assert {e.status for e in entries} == {"live"}
    rows = Counter((slot - 1) % ROWS for slot in slots)
    assert max(rows.values()) - min(rows.values()) == 1


@pytest.mark.parametrize("people", [(600, 250, 150)])
def test_groups_fill_their_quotas_under_races_and_drop_outs(url, tmp_path, people):
    """Every tenth person leaves and is replaced: when all have come each group has its quota, no
    place was given twice, and on the way each has its share of who has come."""
    groups = [
        {"rows": ROWS, "people": n, "levels": {"g": str(g)}, "measured": {}}
        for g, n in enumerate(people)
    ]
    plan = Plan("many", "d" * 64, ROWS, SLOTS, 86_400.0, {"groups": groups})
    words = [tmp_path, url, json.dumps({"groups": groups}), "10"]
    run = subprocess.run([sys.executable, "-c", LAUNCHER, *words], capture_output=True, text=True,
                         timeout=120, check=False)  # fmt: skip
    assert run.returncode == 0, run.stderr
    with Ledger.open(tmp_path, url, plan, NOW) as ledger:
        entries = ledger.entries()
        assert ledger.upcoming(NOW) is None
    live = [place_of(e.slot, len(people)) for e in entries if e.status == "live"]
    assert len(set(live)) == len(live) == SLOTS
    assert len(entries) == SLOTS + STATIONS * len(range(0, SLOTS // STATIONS, 10))
    counts = Counter(group for group, _ in live)
    assert [counts[g] for g in range(len(people))] == list(people)
    numbers = {g: sorted(n for group, n in live if group == g) for g in counts}
    assert numbers == {g: list(range(1, n + 1)) for g, n in enumerate(people)}
    # In the order of reservation; a place that was left is free for whoever comes next.
    here: Counter[int] = Counter()
    for entry in entries:
        group, _ = place_of(entry.slot, len(people))
        here[group] += entry.status == "live"
        shares = [here[g] / n for g, n in enumerate(people)]
        assert max(shares) - min(shares) <= (1 + STATIONS) / min(people)


def test_a_ledger_moves_to_postgresql_with_its_entries_and_is_found_again(tmp_path):
    with Ledger.open(tmp_path, "", PLAN, NOW) as ledger:
        ledger.reserve("A", NOW)
        ledger.complete("A", NOW)
        ledger.reserve("B", NOW)
        before = ledger.entries()
    with Postgres() as server:
        with Ledger.open(tmp_path, server.url, PLAN, NOW) as ledger:
            assert ledger.entries() == before
            assert ledger.reserve("C", NOW).slot == 3
        assert not (tmp_path / "ledger.sqlite").exists()
        with Ledger.existing(tmp_path) as ledger:  # nobody said where: the folder knows
            assert [e.participant for e in ledger.entries()] == ["A", "B", "C"]
        with pytest.raises(InputError, match=r"--ledger = .*: expected .*where this study's ledg"):
            Ledger.open(tmp_path, "postgresql://somebody@elsewhere/x", PLAN, NOW)
        # A folder with other entries of the same study cannot be mixed into it.
        with Ledger.open(tmp_path / "other", "", PLAN, NOW) as ledger:
            ledger.reserve("X", NOW)
        with pytest.raises(InputError, match=r"ledger cannot be used: duplicate key"):
            Ledger.open(tmp_path / "other", server.url, PLAN, NOW)
        assert (tmp_path / "other" / "ledger.sqlite").exists()
