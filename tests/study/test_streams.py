"""Standard streams that nobody reads, or that are closed; Ctrl-C: never a traceback."""

import os
import signal
import subprocess
import sys
import time

import pytest

from seethrough.experiment.cli import COMMANDS

PYTHON = [sys.executable, "-m", "seethrough"]
UNBUFFERED = [sys.executable, "-u", "-m", "seethrough"]


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """A data folder with a ledger, of a session that could not begin."""
    folder = tmp_path_factory.mktemp("d") / "data"
    env = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    words = [*PYTHON, "run", "demo", "--next", "--data", str(folder)]
    assert subprocess.run(words, env=env, capture_output=True, timeout=120).returncode == 2
    return folder


# Commands that print many lines, or one; with {d} a data folder.
PRINTING = [
    "--help",
    "status {d}",
    "check published --config-only",
    "power published --participants 8..9 --replications 20 --effect published --out {d}/../p.html",
    "nonsense",
]


def closed_pipe(words):
    """Run with standard output a pipe that nobody reads any more: (status, standard error)."""
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(words, stdout=write, stderr=subprocess.PIPE, text=True, timeout=180)
    finally:
        os.close(write)
    return done.returncode, done.stderr


@pytest.mark.parametrize(
    ("python", "words"),
    [*((PYTHON, w) for w in PRINTING), *((UNBUFFERED, w) for w in PRINTING[:2])],
)
def test_nobody_reads_the_output(data, python, words):
    status, said = closed_pipe([*python, *words.format(d=data).split()])
    assert "Traceback" not in said and "Exception" not in said and "Broken" not in said, said
    if words == "nonsense":
        assert status == 2 and said.count("\n") == 1
    elif words == "--help":
        assert status in (0, 141)
    else:
        assert status == 141


@pytest.mark.parametrize("words", PRINTING[1:3])
def test_closed_streams(data, words):
    """As of `>&-`: no file that is opened gets a stream's number, so nothing is printed into it."""
    command = " ".join([*PYTHON, words.format(d=data)])
    for closed, status in ((">&-", 0), (">&- 2>&- <&-", 0)):
        done = subprocess.run(
            ["sh", "-c", f"{command} {closed}"], capture_output=True, text=True, timeout=120
        )
        assert (done.returncode, done.stderr) == (status, ""), (closed, done)
    assert (data / "ledger.sqlite").read_bytes()[:15] == b"SQLite format 3"


def test_a_full_disk_where_the_output_goes():
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = subprocess.run(
            [*PYTHON, "check", "demo", "--config-only"], stdout=full, stderr=subprocess.PIPE,
            text=True, timeout=120,
        )  # fmt: skip
    assert (done.returncode, done.stderr) == (
        2,
        "seethrough: output: No space left on device\n",
    )


# Commands that take longer than it takes to interrupt them, and what they have said by then.
LONG = [
    ("simulate published --participants 4 --out {t}/v", "simulating"),
    ("simulate published --mode data --pool 4 --participants 9 --out {t}/d --workers 2", "making"),
    (
        "power published --effect published --participants 8..99 --replications 100000 "
        "--out {t}/p.html",
        "",
    ),
    ("check published --certificate {t}/c.csv", "measuring"),
]


@pytest.mark.parametrize(("words", "begun"), LONG, ids=[w.split()[0] + str(i) for i, (w, _) in
                                                      enumerate(LONG)])  # fmt: skip
def test_ctrl_c_is_one_line(tmp_path, words, begun):
    """The whole foreground group gets the signal, as from a terminal."""
    assert words.split()[0] in COMMANDS
    err = tmp_path / "err"
    with open(err, "w", encoding="utf-8") as file:
        process = subprocess.Popen(
            [*PYTHON, *words.format(t=tmp_path).split()],
            stdout=subprocess.DEVNULL, stderr=file, start_new_session=True,
        )  # fmt: skip
    try:
        until = time.monotonic() + 60
        while begun not in err.read_text() or not begun:
            time.sleep(0.1)
            if not begun and time.monotonic() > until - 58:
                break
            assert process.poll() is None and time.monotonic() < until, err.read_text()
        time.sleep(0.5)
        os.killpg(process.pid, signal.SIGINT)
        assert process.wait(60) == 130, err.read_text()
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    said = [line for line in err.read_text().splitlines() if " after " not in line]
    assert len(said) == 1 and said[0].startswith("seethrough: interrupted"), err.read_text()


def test_ctrl_c_in_a_string_of_code_has_its_status(tmp_path):
    """As modules make their dataclasses: run by `python -m`, it would end by the signal instead."""
    (tmp_path / "interrupted.py").write_text(
        "import sys; from seethrough.experiment import cli\n"
        "def run(words): exec('raise KeyboardInterrupt')\n"
        "cli._run = run; sys.exit(cli.main([]))",
        "utf-8",
    )
    command = [sys.executable, "-m", "interrupted"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (130, "seethrough: interrupted\n")
