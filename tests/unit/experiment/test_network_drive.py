"""Which drives are a network's, by what the system says is mounted; what the ledger makes of it."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from seethrough.experiment.files.network_drive import network_drive
from seethrough.experiment.ledger import ledger_store
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan

MOUNTED = r"""/dev/sda1 / ext4 rw 0 0
server:/far /shared nfs4 rw 0 0
/dev/sdb1 /shared/local ext4 rw 0 0
//lab/share /mnt/lab\040share cifs rw 0 0
me@host: /srv/far fuse.sshfs rw 0 0
"""


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/data/study", ""),
        ("/shared/ann/data", "nfs4"),
        ("/shared/local/data", ""),
        ("/sharedly/data", ""),
        ("/mnt/lab share/study", "cifs"),
        ("/srv/far/x", "fuse.sshfs"),
    ],
)
def test_the_nearest_mount_decides(tmp_path, path, kind):
    mounts = tmp_path / "mounts"
    mounts.write_text(MOUNTED.replace("\\\\", "\\"), encoding="utf-8")
    assert network_drive(Path(path), mounts) == kind


def test_where_the_system_does_not_say_there_is_none(tmp_path):
    assert network_drive(Path("/shared/x"), tmp_path / "missing") == ""


@pytest.mark.parametrize(("kind", "journal"), [("", "wal"), ("nfs4", "delete")])
def test_on_a_network_drive_the_ledger_keeps_no_write_ahead_log(
    tmp_path, monkeypatch, kind, journal
):
    monkeypatch.setattr(ledger_store, "network_drive", lambda path: kind)
    now = datetime(2026, 1, 2, tzinfo=UTC)
    with Ledger.open(tmp_path, "", Plan("t", "d" * 64, 4, 8, 60.0, {}), now) as ledger:
        assert ledger.reserve("A", now).slot == 1
        with ledger_store.exclusive(ledger._engine) as at:
            assert at.exec_driver_sql("PRAGMA journal_mode").scalar() == journal
        assert (tmp_path / "ledger.sqlite-wal").exists() == (journal == "wal")
