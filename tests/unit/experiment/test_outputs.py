"""Files that commands are to write, and arguments: what cannot be is one line in our words, before
any work is done."""

from __future__ import annotations

import pytest

from seethrough.experiment.cli import main
from seethrough.experiment.errors import InputError
from seethrough.experiment.files.outputs import check_output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("check demo --certificate {t}/no/a.csv", "--certificate = {t}/no/a.csv: expected an exis"),
        ("check demo --certificate {t}", "--certificate = {t}: expected a file, there is a folder"),
        (
            "check demo --scenes {t}/a.txt",
            "--scenes = {t}/a.txt: expected a name that ends in .png",
        ),
        (
            "check demo --models {t}/no/a.png",
            "--models = {t}/no/a.png: expected an existing folder",
        ),
        (
            "replay {t} --participant P01 --trial 1 --video {t}/a.avi",
            "--video = {t}/a.avi: expected a name that ends in .mp4",
        ),
        (
            "replay {t} --participant P01 --trial 1 --visibility {t}/no/a.csv",
            "--visibility = {t}/no/a.csv: expected an existing folder, there is no {t}/no",
        ),
    ],
)
def test_where_no_file_can_be_is_said_first(tmp_path, capsys, words, message):
    assert main(words.format(t=tmp_path).split()) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"seethrough: {message.format(t=tmp_path)}")
    assert error.count("\n") == 1


def test_power_writes_over_pages_alone(tmp_path, capsys):
    """A study file given for the page by a slip stays what it is."""
    study = tmp_path / "mine.toml"
    study.write_text("precious", encoding="utf-8")
    assert main(["power", "published", "--effect", "published", "--out", str(study)]) == 2
    assert "expected a name that ends in .html" in capsys.readouterr().err
    assert study.read_text(encoding="utf-8") == "precious"


def test_what_can_be_is_taken(tmp_path):
    check_output("--out", None)
    check_output("--out", tmp_path / "a.PNG", ".png")
    check_output("--out", tmp_path / "a")
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="expected an existing folder"):
        check_output("--out", tmp_path / "file" / "a")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("render abstract --out a.png --seed x", "render: --seed = x: expected a whole number"),
        ("render abstract --out a.png --seed 1.5", "render: --seed = 1.5: expected a whole number"),
        ("render abstract --out", "render: --out: missing, expected a value"),
        ("check demo --seconds soon", "check: --seconds = soon: expected a number"),
        ("simulate demo --out a --mode x", "simulate: --mode = x: expected one of visual, data"),
        ("simulate demo", "simulate: the following arguments are required: --out"),
    ],
)
def test_arguments_are_spoken_of_as_keys_are(capsys, words, message):
    """name = value: expected …, with no type of Python's."""
    with pytest.raises(SystemExit) as left:
        main(words.split())
    assert left.value.code == 2
    assert capsys.readouterr().err.startswith(f"seethrough {message} (see seethrough ")
