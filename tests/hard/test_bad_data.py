"""Malformed data folders by the hundred: one line, exit status 2, no report and no change.

SEETHROUGH_CASES=10000 makes as many; `broken_data.break_one(folder, number)` makes each again.
"""

import io
import os
import shutil
from contextlib import redirect_stderr, redirect_stdout

from broken_data import break_one, valid

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.study import load_study
from seethrough.experiment import cli

CASES = int(os.environ.get("SEETHROUGH_CASES", "120"))


def report(data, out):
    said, err = io.StringIO(), io.StringIO()
    with redirect_stdout(said), redirect_stderr(err):
        status = cli.main(["report", str(data), "--out", str(out)])
    return status, said.getvalue(), err.getvalue()


def read(data, out):
    """What `report` does first, and says; the rest of it would take ten times as long."""
    try:
        load_study(data)
    except DataError as error:
        return 2, "", "".join(f"seethrough: {line}\n" for line in error.shown())
    except OSError as error:
        return 2, "", f"seethrough: {error.filename}: {error.strerror}\n"
    return 0, "read as if nothing were wrong", ""


def files(folder):
    if folder.is_file():
        return {folder: folder.read_bytes()}
    return {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def lines_are_printable(text):
    lines = text.split("\n")
    return lines.pop() == "" and all(
        line.startswith("seethrough: ") and line.isprintable() and len(line) < 2000
        for line in lines
    )


def test_every_malformed_folder_gets_one_line(tmp_path):
    whole, folder, out = valid(tmp_path / "whole"), tmp_path / "data", tmp_path / "report"
    wrong, several = [], 0
    for number in range(CASES):
        shutil.copytree(whole, folder)
        broken = break_one(folder, number)
        before = files(folder)
        try:
            status, said, err = (report if number % 20 == 0 else read)(folder, out)
        except Exception as error:  # whatever it is, it would have been a traceback
            wrong.append((number, broken, f"raised {error!r:.300}"))
        else:
            several += err.count("\n") > 1
            if status != 2 or said or not err or not lines_are_printable(err):
                wrong.append((number, broken, status, said[:80], err[:300]))
        if out.exists() or files(folder) != before:
            wrong.append((number, broken, "something was written"))
            shutil.rmtree(out, ignore_errors=True)
        if folder.is_file():
            folder.unlink()
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{CASES} malformed folders, {several} with more than one line, {len(wrong)} wrong")
    assert not wrong, "\n".join(map(str, wrong[:25]))
    # Only what is wrong in several places, such as a whole column, is told by several lines.
    assert several < CASES / 4
