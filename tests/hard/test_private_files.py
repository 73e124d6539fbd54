"""What is written: whole, its owner's alone, under names that no other process or link has."""

import json
import os
import stat

import pytest
from made_data import Made, make_folder

from seethrough.analysis.files.written import own_folder, write_over
from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.private import write_new
from seethrough.experiment.record.recorder import FileRecorder, Who

WRITES = 200  # of each of two processes


def _container(folder, own, said):
    """A process that thinks it is number 1, as the first in every container does."""
    os.getpid = lambda: 1
    kept = lost = 0
    wrong = []
    for number in range(WRITES):
        try:
            write_new(folder / f"file-{number:03d}", f"{own} {number}\n" * 200)
            kept += 1
        except FileExistsError:  # the other was first
            lost += 1
        except OSError as error:  # anything else is a half file that somebody took away
            wrong.append(f"{number}: {error!r}")
    said.write_text(json.dumps([kept, lost, wrong]))


def test_two_containers_that_write_the_same_names_leave_each_file_whole(tmp_path):
    place = tmp_path / "data"
    place.mkdir()
    children = []
    for own in "ab":
        child = os.fork()
        if child == 0:
            _container(place, own, tmp_path / own)
            os._exit(0)
        children.append(child)
    assert [os.waitpid(child, 0)[1] for child in children] == [0, 0]
    kept, lost, wrong = zip(
        *(json.loads((tmp_path / own).read_text()) for own in "ab"), strict=True
    )
    assert (sum(kept), sum(lost), *wrong) == (WRITES, WRITES, [], [])
    assert sorted(p.name for p in place.iterdir()) == [f"file-{n:03d}" for n in range(WRITES)]
    for number in range(WRITES):
        text = (place / f"file-{number:03d}").read_text()
        assert text in {f"{own} {number}\n" * 200 for own in "ab"}


def test_a_half_file_of_somebody_else_stays(tmp_path, monkeypatch):
    """The same random name twice, which will not happen: nothing is taken from the other."""
    monkeypatch.setattr("secrets.token_hex", lambda n: "00" * n)
    half = tmp_path / f".x.{'00' * 8}"
    half.write_text("the other's")
    with pytest.raises(FileExistsError):
        write_new(tmp_path / "x", "mine")
    with pytest.raises(FileExistsError):
        write_over(tmp_path / "x", "mine")
    assert half.read_text() == "the other's"


def test_nothing_is_written_through_a_planted_link(tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("mine")
    for name in ("a", "b"):
        (tmp_path / name).symlink_to(victim)
    with pytest.raises(FileExistsError):
        write_new(tmp_path / "a", "theirs")
    write_over(tmp_path / "b", "theirs")
    assert victim.read_text() == "mine" and (tmp_path / "b").read_text() == "theirs"
    (tmp_path / "nowhere").symlink_to(tmp_path / "made")
    with pytest.raises(FileExistsError):
        write_new(tmp_path / "nowhere", "theirs")
    (tmp_path / "folder").symlink_to(tmp_path, target_is_directory=True)
    with pytest.raises(NotADirectoryError):
        own_folder(tmp_path / "folder")
    assert not (tmp_path / "made").exists()


@pytest.mark.parametrize("place", ["data", "data/human", "data/human/P01", "data/human/P01/traces"])
def test_no_session_is_recorded_into_a_planted_link(tmp_path, place):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    link = tmp_path / "study" / place
    link.parent.mkdir(parents=True)
    link.symlink_to(elsewhere, target_is_directory=True)
    with pytest.raises(InputError, match="a link: expected a folder of this study's own"):
        FileRecorder(tmp_path / "study", Who("t", "P01", "human", 1, {}))
    assert list(elsewhere.iterdir()) == []


def test_a_report_is_its_owners_alone_and_replaces_links(tmp_path):
    data = make_folder(tmp_path / "data", Made(participants=3, trials=1))
    victim, out = tmp_path / "victim", tmp_path / "out"
    victim.write_text("mine")
    old = os.umask(0)
    try:
        assert cli.main(["report", str(data), "--out", str(out)]) == 0
        files = {stat.S_IMODE(p.stat().st_mode) for p in out.rglob("*") if p.is_file()}
        folders = {stat.S_IMODE(p.stat().st_mode) for p in (out, *out.rglob("*")) if p.is_dir()}
        assert (files, folders) == ({0o600}, {0o700})
        assert not [p for p in out.rglob(".*") if p.is_file()]
    finally:
        os.umask(old)
    page = (out / "report.md").read_text()
    assert "Tables without hash chains" in page  # made by a test: nothing shows whether it changed
    assert "There is no ledger in this folder" in page
