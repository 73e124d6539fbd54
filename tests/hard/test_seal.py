"""The seal: what a shell makes of the same files, and nothing but the files' names and bytes."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest
from made_chains import chain, close, enter
from made_data import Made, make_folder

from seethrough.analysis.errors import DataError
from seethrough.analysis.load.chain import link, start_of
from seethrough.analysis.load.seal import seal
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report
from seethrough.experiment import cli

# CONVENTIONS.md has these words: a reader without this program can make the same seal.
SHELL = (
    "find dataset_description.json certificate.csv models plugins data/human -type f "
    "! -path '*/.*' 2>/dev/null | LC_ALL=C sort | tr '\\n' '\\0' | xargs -0 sha256sum | sha256sum"
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = make_folder(tmp_path_factory.mktemp("made") / "data", Made(participants=3, trials=1))
    chain(folder)
    enter(folder)
    (folder / "models").mkdir()
    (folder / "models" / "a b.npz").write_bytes(bytes(range(256)))
    return folder


@pytest.fixture
def folder(made, tmp_path):
    return shutil.copytree(made, tmp_path / "data")


def sealed(folder, *words):
    return cli.main(["seal", str(folder), *words])


def test_the_seal_is_what_a_shell_makes_of_the_files(folder, capsys):
    assert sealed(folder) == 0
    digest, rest = capsys.readouterr().out.split("\n", 1)
    shell = subprocess.run(
        ["sh", "-c", SHELL], cwd=folder, capture_output=True, text=True, check=True
    )
    assert shell.stdout.split()[0] == digest and rest == ""
    conventions = Path(cli.__file__).parents[1] / "CONVENTIONS.md"
    assert SHELL.replace("data/human", "data/SOURCE") in " ".join(conventions.read_text().split())


HARMLESS = {
    "a file manager's folder": lambda own: put(own / ".cache" / "y.csv"),
    "another alphabet": lambda own: put(own / "ä 中.txt"),
    "spaces": lambda own: put(own / " a  b .txt"),
    "a dash first": lambda own: put(own / "-n"),
}
REFUSED = {
    "a line break": (lambda own: put(own / "a\nb.txt"), "expected a name that prints"),
    "a backslash": (lambda own: put(own / "a\\b.txt"), "expected a name that prints"),
    "no text": (lambda own: put(Path(os.fsdecode(os.fsencode(own) + b"/\xff.txt"))),
                "expected a name that prints"),
    "a link within": (lambda own: linked(own / "traces"), "a link: expected the file or folder"),
    "a link to itself": (lambda own: (own / "loop").symlink_to("."), "a link: expected the file"),
    "the description a link": (lambda own: linked(own.parents[2] / "dataset_description.json"),
                               "dataset_description.json: a link: expected the file itself"),
    "a source a link": (lambda own: linked(own.parent), "data/human: a link: expected the folder"),
}  # fmt: skip


def put(path):
    path.parent.mkdir(exist_ok=True)
    path.write_text("x")


def linked(path):
    """The same thing at another place of the data folder, and a link to there."""
    place = next(p for p in path.parents if (p / "ledger.sqlite").exists()) / "moved"
    path.rename(place)
    path.symlink_to(place)


@pytest.mark.parametrize("name", HARMLESS)
def test_any_name_that_prints_is_sealed_as_a_shell_does(name, folder):
    HARMLESS[name](folder / "data" / "human" / "P01")
    shell = subprocess.run(["sh", "-c", SHELL], cwd=folder, capture_output=True, check=True)
    assert shell.stdout.decode().split()[0] == seal(folder, "human")[0]


@pytest.mark.parametrize("name", REFUSED)
def test_what_a_shell_would_seal_otherwise_is_refused(name, folder):
    """Links that one follows and another does not, names that sha256sum writes in its own way."""
    break_it, line = REFUSED[name]
    break_it(folder / "data" / "human" / "P01")
    with pytest.raises(DataError, match=line) as caught:
        seal(folder, "human")
    assert len(caught.value.shown()) == 1 and caught.value.shown()[0].isprintable()


def test_times_and_the_order_on_disk_do_not_matter_and_every_byte_does(folder, tmp_path, capsys):
    before = seal(folder, "human")
    other = tmp_path / "other"
    files = sorted((p for p in folder.rglob("*") if p.is_file()), reverse=True)
    for path in files:  # made in another order, at another time
        new = other / path.relative_to(folder)
        new.parent.mkdir(parents=True, exist_ok=True)
        new.write_bytes(path.read_bytes())
        os.utime(new, (1, 1))
    (other / ".DS_Store").write_text("a file manager's")
    (other / "data" / "human" / "P01" / ".DS_Store").write_text("a file manager's")
    assert seal(other, "human") == before
    assert sealed(other, "--verify", before[0].upper()) == 0
    assert sealed(other, "--verify", "0" * 64) == 1
    assert sealed(other, "--verify", "0" * 63) == 2
    capsys.readouterr()
    for path in files:
        if "ledger" not in path.name:
            new = other / path.relative_to(folder)
            new.write_bytes(path.read_bytes() + b" ")
            assert seal(other, "human") != before, path
            new.unlink()
            assert seal(other, "human") != before, path
            new.write_bytes(path.read_bytes())
    assert seal(other, "human") == before


def test_the_report_prints_the_seal_and_what_the_ledger_lets_be_known(folder):
    text = as_markdown(make_report(folder, Options()))
    assert f"Seal of everything recorded: {seal(folder, 'human')[0]}." in text
    assert "The ledger agrees: 3 complete there, all of them complete here." in text
    (folder / "ledger.sqlite").unlink()
    text = as_markdown(make_report(folder, Options()))
    assert "it cannot be known from here whether whole participants were removed" in text


def test_a_broken_folder_is_not_sealed(folder, capsys):
    next(folder.rglob("*_end.json")).unlink()
    assert sealed(folder) == 2
    assert "complete in the ledger, but no end file says so" in capsys.readouterr().err


def test_a_forger_who_makes_the_chain_again_is_seen_by_the_seal_alone(folder, capsys):
    """The threat that chains do not cover (SECURITY.md), and what a seal kept elsewhere does."""
    before = seal(folder, "human")[0]
    table = next(folder.rglob("*_trials_data.csv"))
    header, *rows = table.read_text().rstrip("\n").split("\n")
    names = header.split(",")
    sidecar = json.loads(table.with_suffix(".json").read_text())
    value, out = start_of(sidecar, header), [header]
    for row in rows:
        cells = row.split(",")[:-1]
        cells[names.index("time")] = "1.0"
        value = link(value, ",".join(cells))
        out.append(",".join([*cells, value]))
    table.write_text("\n".join(out) + "\n")
    end = json.loads(next(table.parent.glob("*_end.json")).read_text())
    del end["seal"]
    close(table, {**end, "chain": value})
    assert sealed(folder, "--verify", before) == 1
    assert "a file was changed, added or removed" in capsys.readouterr().err
