"""Malformed studies by the hundred: each gets a line a fault and exit status 2, nothing is written.

SEETHROUGH_CASES=10000 makes as many; the numbers of cases that fail are printed, and
`broken_configs.case(number)` makes each again.
"""

import io
import os
from contextlib import redirect_stderr, redirect_stdout

import pytest
from broken_configs import BASE, KINDS, case, toml

from seethrough.experiment import cli
from seethrough.experiment.errors import MOST
from seethrough.experiment.files import trust

CASES = int(os.environ.get("SEETHROUGH_CASES", "300"))


def check(path):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            status = cli.main(["check", str(path), "--config-only"])
        except SystemExit as left:
            status = left.code
    return status, out.getvalue(), err.getvalue()


def is_one_line(text):
    """One line wherever it is shown: no control character, no other kind of line's end."""
    return (
        text.startswith("seethrough: ")
        and text.endswith("\n")
        and text[:-1].isprintable()
        and 20 < len(text) < 2000
    )


# What nobody should have to read: regular expressions, Python's and pydantic's words.
JARGON = (
    "^[",
    "[A-Z",
    "\\d",
    "(?:",
    "match pattern",
    "Input should",
    " dict",  # not that of "predictions"
    "dict[",
    "tuple",
    "NoneType",
    "class ",
)


def is_lines(text, faults=()):
    """A line for each fault, none twice, and each of the faults named; in plain words."""
    lines = text.splitlines(keepends=True)
    return (
        0 < len(lines) <= MOST + 1
        and all(map(is_one_line, lines))
        and len(set(lines)) == len(lines)
        and all(
            any(f"{fault} = " in line or f"{fault}: " in line for line in lines) for fault in faults
        )
        and not any(word in line.partition(": expected ")[2] for word in JARGON for line in lines)
    )


def test_what_the_cases_start_from_is_valid(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(toml(BASE), "utf-8")
    assert check(path)[0] == 0


def test_every_malformed_study_gets_a_line_a_fault(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv(trust.TOLD, "")
    monkeypatch.setenv(trust.HOME, str(tmp_path.with_name("home")))
    path = tmp_path / "study.toml"
    wrong, valid = [], 0
    for number in range(CASES):
        broken = case(number)
        path.write_bytes(broken.data)
        for name, data in broken.beside.items():
            (tmp_path / name).write_bytes(data)
        try:
            status, out, err = check(path)
        except Exception as error:  # whatever it is, it would have been a traceback
            wrong.append((number, broken.kind, broken.what, f"raised {error!r:.200}"))
            continue
        must_pass = broken.kind == "as saved" and not broken.must_fail
        if status == 0 and not broken.must_fail:
            valid += 1
        elif must_pass or status != 2 or not is_lines(err, broken.faults) or out:
            wrong.append((number, broken.kind, broken.what, status, out[:80], err[:300]))
        elif {p.name for p in tmp_path.iterdir()} != {
            path.name,
            *broken.beside,
        } or path.read_bytes() != broken.data:
            wrong.append((number, broken.kind, broken.what, "something was written"))
        for name in broken.beside:
            (tmp_path / name).unlink()
    print(f"{CASES} malformed studies, {valid} of them valid by chance, {len(wrong)} wrong")
    assert not wrong, "\n".join(map(str, wrong[:20]))
    assert valid < 2 * CASES / len(KINDS)  # what editors do is valid half the time


@pytest.mark.parametrize("name", ["", "nothing.toml", "a\nb", ".", "/", "x" * 5000, "-", "a\0b"])
def test_what_is_no_file_gets_one_line(tmp_path, monkeypatch, name):
    monkeypatch.chdir(tmp_path)
    status, out, err = check(name)
    assert (status, out) == (2, "") and is_one_line(err)
    assert list(tmp_path.iterdir()) == []
