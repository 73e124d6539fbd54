"""The ledger on a disk that is full or read-only: one line, and nothing that was told is lost."""

import re
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest
from disks import read_only, small_disk

from seethrough.experiment import cli
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan

PLAN = Plan("t", "d" * 64, 4, 2000, 86400.0, {})
NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)

# Reserves slots through the command line's own way with errors, and tells of each.
RESERVE = """
import argparse, os, resource, sys
from datetime import UTC, datetime
from pathlib import Path
from seethrough.experiment import cli
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan

data, largest, user = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
if user:
    os.setegid(user)
    os.seteuid(user)
if largest:
    resource.setrlimit(resource.RLIMIT_FSIZE, (largest, largest))
NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)

def reserve(arguments):
    with Ledger.open(data, "", Plan("t", "d" * 64, 4, 2000, 86400.0, {}), NOW) as ledger:
        for number in range(100):
            print(ledger.reserve(f"P{number}", NOW).participant, flush=True)

class Parser:
    def parse_args(self, words):
        return argparse.Namespace(run=reserve)

cli._parser = lambda words: Parser()
sys.exit(cli.main([]))
"""

# A participant's session on a disk that becomes full between its last page and the ledger.
SESSION = """
import resource, sys
from pathlib import Path
from seethrough.experiment import cli
from seethrough.experiment.commands.sessions import run
from seethrough.experiment.study.config import load
from seethrough.experiment.record.recorder import FileRecorder, Who

def play(study, participant, slot, source, data, guard):
    provenance = {"study_sha256": study.digest()}
    who = Who(study.general.name, participant, source, slot, provenance)
    FileRecorder(data, who).close("complete")
    resource.setrlimit(resource.RLIMIT_FSIZE, (1, 1))
    return "complete"

run._play = play
sys.exit(cli.main(["run", "demo", "--next", "--data", sys.argv[1]]))
"""


def started(script, *words):
    command = [sys.executable, "-c", script, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def is_one_line(run, pattern):
    assert run.returncode == 2, run.stderr
    assert re.fullmatch(rf"seethrough: [^\n]*{pattern}[^\n]*\n", run.stderr), run.stderr


# In KiB: room for the first file alone, for the tables, for a few reservations.
@pytest.mark.parametrize("kilobytes", [4, 28, 60, 150])
def test_a_full_disk_keeps_every_slot_that_was_told(tmp_path, kilobytes):
    disk = tmp_path / "disk"
    with small_disk(disk, kilobytes) as largest:
        # Where no disk can be mounted: half of it for the larger of the ledger's two files.
        full = started(RESERVE, disk / "study", largest and 512 * kilobytes, 0)
        is_one_line(full, r"ledger\.sqlite: .*(disk is full|disk I/O error)")
        told = full.stdout.split()
        copy = tmp_path / "copy"
        subprocess.run(["cp", "-r", str(disk / "study"), str(copy)], check=True)
    assert bool(told) == (kilobytes == 150)
    with Ledger.open(copy, "", PLAN, NOW) as ledger:  # where there is room again
        assert [e.participant for e in ledger.entries()] == told
        assert [e.slot for e in ledger.entries()] == list(range(1, len(told) + 1))
        assert ledger.reserve("next", NOW).slot == len(told) + 1


def test_a_read_only_disk_is_one_line_whether_a_ledger_is_there_or_not(tmp_path):
    refused = r"(Read-only file system|Permission denied)"
    with read_only(tmp_path) as user:
        is_one_line(started(RESERVE, tmp_path / "study", 0, user), refused)
    assert not list(tmp_path.iterdir())
    with Ledger.open(tmp_path / "study", "", PLAN, NOW) as ledger:
        ledger.reserve("P0", NOW)
    before = {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()}
    with read_only(tmp_path) as user:
        is_one_line(started(RESERVE, tmp_path / "study", 0, user), refused)
    assert {p: p.read_bytes() for p in tmp_path.rglob("*") if p.is_file()} == before


def test_a_complete_session_that_the_ledger_could_not_note_is_noted_later(tmp_path, capsys):
    data = tmp_path / "data"
    run = started(SESSION, data)
    assert run.returncode == 2
    assert run.stderr.splitlines()[-1] == (
        f"seethrough: {data}/ledger.sqlite: the ledger cannot be used: disk I/O error; "
        "the session of P01 is complete on disk: `seethrough status` enters it"
    )
    (end,) = Path(data).rglob("*_end.json")
    assert '"status": "complete"' in end.read_text("utf-8")
    assert cli.main(["status", str(data)]) == 0
    said = capsys.readouterr().out
    assert "mended    P01: complete on disk, live in the ledger: completed" in said
    assert "1 complete, 0 open" in said
