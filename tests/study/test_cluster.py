"""`--scheduler`: a real Dask scheduler, worker processes, one of them killed."""

import csv
import os
import signal
import socket
import time

import pytest
from distributed import Client, LocalCluster

from experiment import cli
from experiment.config import load
from experiment.participants import batch, cluster
from experiment.participants.batch_files import Results

PEOPLE = 8
SMALL = ["simulate", "demo", "--mode", "data", "--pool", "1", "--participants", str(PEOPLE)]


@pytest.fixture(scope="module")
def tables(tmp_path_factory):
    """Made once: what is tested is who simulates."""
    path = tmp_path_factory.mktemp("tables") / "demo.npz"
    batch.fill(batch.Batch("demo", 1, 1, path))
    batch.play_chunk(range(1, 5))
    batch.keep_tables()
    return path


@pytest.fixture(scope="module")
def dask():
    """A scheduler and two worker processes, which end with the test."""
    with LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
    ) as cluster:
        yield cluster


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch):
    monkeypatch.setattr("experiment.participants.batch_files.CHUNK", 1)


def files(out):
    """Every file but the description's, byte for byte."""
    folder = out / "data" / "simulated"
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.glob("*/*"))}


def test_a_killed_worker_costs_nothing_and_the_numbers_are_those_of_one_process(
    dask, tables, tmp_path
):
    job = batch.Batch("demo", 1, 1, tables)
    study = load("demo")
    with Results(tmp_path / "many", study, job.about(study)) as results:
        chunks = results.missing(PEOPLE)
        played = cluster.play(job, chunks, dask.scheduler_address)
        results.add(next(played))
        with Client(dask.scheduler_address, set_as_default=False) as client:
            before = client.run(os.getpid)
            busy = [address for address, work in client.processing().items() if work]
            assert len(before) == 2 and busy
            victim = before[busy[0]]
            os.kill(victim, signal.SIGKILL)
        for chunk in played:
            results.add(chunk)
        with Client(dask.scheduler_address, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)  # the one that died was replaced
            assert victim not in client.run(os.getpid).values()
    assert cli.main([*SMALL, "--tables", str(tables), "--out", str(tmp_path / "one")]) == 0
    assert files(tmp_path / "many") == files(tmp_path / "one")
    assert len(files(tmp_path / "many")) == 4 * PEOPLE


def test_the_command_goes_on_on_the_cluster_where_one_process_stopped(dask, tables, tmp_path):
    out = tmp_path / "out"
    words = [*SMALL, "--tables", str(tables), "--out", str(out)]
    assert cli.main([*words[:-2], "--participants", "3", "--out", str(out)]) == 0
    assert cli.main([*words, "--scheduler", dask.scheduler_address]) == 0
    lines = [line for name, text in files(out).items() if name.endswith("trials_data.csv")
             for line in csv.DictReader(text.decode().splitlines())]  # fmt: skip
    ids = [line["row_id"] for line in lines]
    assert len(ids) == len(set(ids)) == 8 * PEOPLE


def test_a_scheduler_that_is_not_there_is_one_line_in_a_few_seconds(tables, tmp_path, capsys):
    with socket.socket() as nobody:  # bound, so that nobody else can be; it never listens
        nobody.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{nobody.getsockname()[1]}"
        began = time.monotonic()
        words = [*SMALL, "--tables", str(tables), "--out", str(tmp_path / "x")]
        assert cli.main([*words, "--scheduler", address]) == 2
    told = capsys.readouterr().err
    (line,) = [text for text in told.splitlines() if not text.startswith("simulating: ")]
    assert line.startswith(f"seethrough: --scheduler = {address}: no Dask scheduler answers")
    assert time.monotonic() - began < 20
    assert not list((tmp_path / "x").glob("data/simulated/*"))
