"""`--scheduler`: a real Dask scheduler, worker processes, one of them killed."""

import csv
import os
import signal
import socket
import time
from dataclasses import replace

import pytest
from distributed import LocalCluster
from small_study import SMALL

from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.people.runs import batch, cluster
from seethrough.experiment.people.runs.batch_files import Results
from seethrough.experiment.study.config import load

PEOPLE = 3


@pytest.fixture(scope="module")
def job(tmp_path_factory):
    """A study's file, and its tables, made once."""
    folder = tmp_path_factory.mktemp("small")
    (folder / "small.toml").write_text(SMALL, encoding="utf-8")
    made = batch.Batch(str(folder / "small.toml"), 1, 1, folder / "small.db")
    batch.fill(made)
    batch.play_chunk(range(1, PEOPLE + 1))
    batch.keep_tables()
    return made


def words(job, out, people=PEOPLE):
    """The command that simulates the job."""
    return ["simulate", job.study, "--mode", "data", "--pool", "1", "--tables", str(job.tables),
            "--participants", str(people), "--out", str(out)]  # fmt: skip


@pytest.fixture(scope="module")
def dask():
    """A scheduler and two worker processes, which end with the test."""
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0", host="127.0.0.1"
    ) as cluster:
        yield cluster


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    monkeypatch.setattr("seethrough.experiment.people.runs.batch_files.CHUNK", 1)


def files(out):
    """Every file but the description's, byte for byte."""
    folder = out / "data" / "simulated"
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.glob("*/*"))}


def held_back(folder):
    """`cluster._work`, which notes who plays a slot and, but for the first, waits for a gate."""

    def work(needs, job, tables, slots):
        import os
        import time

        from seethrough.experiment.people.runs import (
            cluster,  # the worker's own: nobody has patched it
        )

        (folder / f"{slots[0]}-{os.getpid()}").touch()
        while slots[0] > 1 and not (folder / "gate").exists():
            time.sleep(0.02)
        return cluster._work(needs, job, tables, slots)

    return work  # a function within a function: sent by its value


def busy(folder):
    """Slots and process ids of those that wait, or waited, at the gate."""
    notes = [path.name.split("-") for path in folder.glob("*-*")]
    return sorted((int(slot), int(pid)) for slot, pid in notes if slot != "1")


def test_a_killed_worker_costs_nothing_and_the_numbers_are_those_of_one_process(
    dask, job, tmp_path, monkeypatch
):
    gates = tmp_path / "gates"
    gates.mkdir()
    monkeypatch.setattr(cluster, "_work", held_back(gates))
    study = load(job.study)
    with Results(tmp_path / "many", study, job.about(study)) as results:
        chunks = results.missing(range(1, PEOPLE + 1))
        played = cluster.play(job, chunks, dask.scheduler_address)
        results.add(next(played))
        while not busy(gates):
            time.sleep(0.02)
        slot, victim = busy(gates)[0]
        os.kill(victim, signal.SIGKILL)  # in the middle of its chunk: the gate is closed
        (gates / "gate").touch()
        for chunk in played:
            results.add(chunk)
    assert len([pid for played, pid in busy(gates) if played == slot and pid != victim]) == 1
    assert cli.main(words(job, tmp_path / "one")) == 0
    assert files(tmp_path / "many") == files(tmp_path / "one")
    assert len(files(tmp_path / "many")) == 4 * PEOPLE


def test_the_command_goes_on_on_the_cluster_where_one_process_stopped(dask, job, tmp_path):
    out = tmp_path / "out"
    assert cli.main(words(job, out, 1)) == 0
    assert cli.main([*words(job, out), "--scheduler", dask.scheduler_address]) == 0
    lines = [line for name, text in files(out).items() if name.endswith("trials_data.csv")
             for line in csv.DictReader(text.decode().splitlines())]  # fmt: skip
    ids = [line["row_id"] for line in lines]
    assert len(ids) == len(set(ids)) == 2 * PEOPLE


def test_workers_of_another_version_are_refused_in_a_line(dask, job):
    other = replace(job, code="0123456789ab")
    message = rf"^--scheduler = {dask.scheduler_address}: a worker has code [0-9a-f]{{12}}: expect"
    with pytest.raises(InputError, match=message):
        next(cluster.play(other, [(1,)], dask.scheduler_address))


def test_a_scheduler_without_workers_is_one_line(job, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 2.0)
    with LocalCluster(n_workers=0, dashboard_address=":0", host="127.0.0.1") as nobody:
        address = nobody.scheduler_address
        with pytest.raises(InputError, match=rf"^--scheduler = {address}: no worker answers: .+"):
            next(cluster.play(job, [(1,)], address))


def test_a_scheduler_that_is_not_there_is_one_line(job, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    with socket.socket() as nobody:  # bound, so that nobody else can be; it never listens
        nobody.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{nobody.getsockname()[1]}"
        assert cli.main([*words(job, tmp_path / "x"), "--scheduler", address]) == 2
    told = capsys.readouterr().err
    (line,) = [text for text in told.splitlines() if not text.startswith("simulating: ")]
    assert line.startswith(f"seethrough: --scheduler = {address}: no Dask scheduler answers")
    assert not list((tmp_path / "x").glob("data/simulated/*"))
