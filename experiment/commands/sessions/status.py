"""`seethrough status`: slots, who has them, the balance, and what to run next."""

from __future__ import annotations

import argparse
import shlex
from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.analysis.load.ledger import differences
from seethrough.analysis.load.whole import examined
from seethrough.experiment.errors import one_line
from seethrough.experiment.files.folders import folder_of, taken
from seethrough.experiment.ledger.ledger_slots import (
    COMPLETE,
    LIVE,
    SURPLUS,
    VOID,
    Entry,
    Places,
    place_of,
    row_of,
)

if TYPE_CHECKING:
    from seethrough.experiment.ledger.ledger import Ledger


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The command's own arguments."""
    parser.add_argument("data", metavar="DATA", type=Path, help="the study's data folder")
    parser.add_argument("--ledger", default="", metavar="URL", help="where it is, if not noted")


def run(arguments: argparse.Namespace) -> int:
    """Print the ledger and what was changed in the files; 0, or 1 if something was."""
    from seethrough.experiment.ledger.ledger import Ledger
    from seethrough.experiment.ledger.ledger_files import reconcile

    now = datetime.now(UTC)
    with Ledger.existing(arguments.data, arguments.ledger) as ledger:
        changes = reconcile(ledger, arguments.data, now)
        study = study_words(arguments.data, ledger.plan.study)
        lines = [*(f"mended    {line}" for line in changes), *describe(ledger, now, study)]
        entries = ledger.entries()
    notes, elsewhere = notes_of(entries, arguments.data)
    lines[-1:-1] = [f"files     {line}" for line in notes]
    here = {e.participant: e.status for e in entries if e.participant not in elsewhere}
    problems = [one_line(line) for line in _changed(arguments.data, here)]
    whole = "as they were written: chains hold, and nobody in the ledger lacks files"
    files = [f"files     {line}" for line in problems or [whole]]
    print("\n".join([*lines[:-1], *files, lines[-1]]))
    return 1 if problems else 0


def notes_of(entries: Sequence[Entry], data: Path) -> tuple[list[str], set[str]]:
    """What the ledger knows and the files here do not, where that may be as it should be; and who
    was played into another station's folder."""
    from seethrough.experiment.ledger.ledger_place import POINTER

    notes: list[str] = []
    elsewhere: set[str] = set()
    stations = (data / POINTER).exists()  # they may have folders of their own
    for entry in entries:
        folder = folder_of(data, "human", entry.participant)
        status, there = entry.status, any(folder.glob("*_trials_data.json"))
        if status in (COMPLETE, SURPLUS) and not there and stations:
            notes.append(f"{entry.participant}: {status} in the ledger, no files here")
            elsewhere.add(entry.participant)
        elif status == LIVE and not there:
            notes.append(f"{entry.participant}: open, no files: never begun, or they were removed")
    return notes, elsewhere


def _changed(data: Path, entries: Mapping[str, str]) -> list[str]:
    """What is not as it was written, and what ledger and files say of one another."""
    if not taken(data, "human"):
        return list(differences(entries, []))
    return examined(data, "human", entries).problems


def study_words(data: Path, name: str) -> str:
    """The study as `seethrough run` takes it: as noted by the last run, else a shipped one."""
    from seethrough.experiment.ledger.ledger_place import noted_study
    from seethrough.experiment.study.config import shipped

    noted = noted_study(data) or (name if name in shipped() else "")
    return shlex.quote(noted) if noted else f"[the file of the study {name}]"


def describe(ledger: Ledger, now: datetime, study: str) -> list[str]:
    """The ledger in lines for the experimenter."""
    plan, entries = ledger.plan, ledger.entries()
    of = {s: [e for e in entries if e.status == s] for s in (COMPLETE, LIVE, VOID, SURPLUS)}
    stale = ledger.stale(now)
    held = {e.slot for e in (*of[COMPLETE], *of[LIVE])}
    groups = len(plan.groups)
    free = sum(
        (number - 1) * groups + which + 1 not in held
        for which, group in enumerate(plan.groups)
        for number in range(1, group.people + 1)
    )
    idle = f" ({len(stale)} stale)" if stale else ""
    return [
        f"study     {plan.study}: {plan.participants} participants wanted, "
        f"{' + '.join(str(g.rows) for g in plan.groups)} rows of the design; ledger {ledger.where}",
        f"slots     {len(of[COMPLETE])} complete, {len(of[LIVE])} open{idle}, "
        f"{free} free, {len(of[VOID])} void entries",
        *_balance(of[COMPLETE], of[LIVE], plan.groups),
        *_people("open", of[LIVE], {e.participant for e in stale}),
        *_people("void", of[VOID]),
        *_people("surplus", of[SURPLUS]),
        f"next      {_next(ledger, now, study)}",
    ]


def _balance(
    complete: Sequence[Entry], live: Sequence[Entry], groups: Sequence[Places]
) -> list[str]:
    lines = []
    for which, group in enumerate(groups):
        name = "/".join(group.levels.values())
        done, open_ = (_rows(entries, which, groups) for entries in (complete, live))
        uneven = max(done[r] for r in range(group.rows)) - min(done[r] for r in range(group.rows))
        word = "completed rows are even" if not uneven else f"completed rows differ by {uneven}"
        if name:
            counts = f"{done.total()} complete, {open_.total()} open of {group.people}"
            word = f"{name}: {counts}; {word}"
        lines.append(f"{'balance' if not which else '':<9} {word}")
        lines += [f"          row {r + 1}: {done[r]} complete, {open_[r]} open"
                  for r in range(group.rows)]  # fmt: skip
    return lines


def _rows(entries: Sequence[Entry], which: int, groups: Sequence[Places]) -> Counter[int]:
    """How many of a group's entries each row has."""
    places = [place_of(entry.slot, len(groups)) for entry in entries]
    return Counter(row_of(number, groups[which].rows) for group, number in places if group == which)


def _people(what: str, entries: Sequence[Entry], stale: Sequence[str] | set[str] = ()) -> list[str]:
    return [
        f"{what:<9} {e.participant}, slot {e.slot}, since {e.changed}"
        + (" (stale: its slot may be given out)" if e.participant in stale else "")
        + (f": {one_line(e.why)}" if e.why else "")
        for e in entries
    ]


def _next(ledger: Ledger, now: datetime, study: str) -> str:
    slot = ledger.upcoming(now)
    if slot is None:
        return "nobody: every slot is complete or open; wait for the open ones, or withdraw"
    groups = ledger.plan.groups
    which, number = place_of(slot, len(groups))
    beyond = " (past the number wanted)" if number > groups[which].people else ""
    row = row_of(number, groups[which].rows) + 1
    return f"seethrough run {study} --next: slot {slot}, row {row}{beyond}"
