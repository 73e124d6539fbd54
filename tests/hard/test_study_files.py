"""What a study may make the program read: its own files, beside it, regular, of a sensible size."""

import copy
import io
import os
import time
from contextlib import redirect_stderr, redirect_stdout

import pytest
from broken_configs import BASE, toml

from seethrough.experiment import cli

QUICK = 5.0  # s of this process's own time; what these files took before was minutes, or for ever
RAW = toml(BASE)


def check(path):
    """(status, standard error, seconds of this process) of checking a study."""
    out, err, began = io.StringIO(), io.StringIO(), time.process_time()
    with redirect_stdout(out), redirect_stderr(err):
        status = cli.main(["check", str(path), "--config-only"])
    return status, err.getvalue(), time.process_time() - began


@pytest.fixture
def folder(tmp_path):
    """Files beside a study, good and bad, and one outside that it must not get."""
    own = tmp_path / "study"
    (own / "texts").mkdir(parents=True)
    (own / "texts" / "consent.txt").write_text("\ufeffYes?", "utf-8")
    (tmp_path / "secret.txt").write_text("secret")
    os.mkfifo(own / "pipe")
    (own / "out.txt").symlink_to("../secret.txt")
    (own / "in.txt").symlink_to("texts/consent.txt")
    (own / "zero").symlink_to("/dev/zero")
    (own / "big.txt").write_bytes(b"a" * (2**18 + 1))
    (own / "gone.txt").symlink_to("nothing")
    (own / "loop.txt").symlink_to("loop.txt")
    (own / "empty.txt").write_text("\ufeff \n", "utf-8")
    return own


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("../secret.txt", "not a file beside the study"),
        ("texts/../../secret.txt", "not a file beside the study"),
        ("/etc/passwd", "not a file beside the study"),
        ("C:\\secret.txt", "not a file beside the study"),
        ("/dev/zero", "not a file beside the study"),
        ("out.txt", "a link out of the study's folder"),
        ("loop.txt", "a link that leads to itself"),
        ("empty.txt", "nothing is written in it"),
        ("zero", "a link out of the study's folder"),
        ("pipe", "not a regular file"),
        ("texts", "Is a directory"),
        ("gone.txt", "No such file"),
        ("big.txt", "more than 262144 bytes"),
    ],
)
def test_a_consent_text_lies_beside_its_study(folder, name, said):
    study = copy.deepcopy(BASE)
    study["questions"]["consent"]["file"] = name
    (folder / "s.toml").write_text(toml(study), "utf-8")
    status, err, seconds = check(folder / "s.toml")
    assert status == 2 and err.count("\n") == 1 and seconds < QUICK
    assert "questions.consent.file = " in err and said in err and "secret\n" not in err


@pytest.mark.parametrize("name", ["texts/consent.txt", "in.txt"])
def test_a_consent_text_in_a_folder_beside_the_study_is_read(folder, name):
    from seethrough.experiment.study.config import load

    study = copy.deepcopy(BASE)
    study["questions"]["consent"]["file"] = name
    (folder / "s.toml").write_text(toml(study), "utf-8")
    assert load(str(folder / "s.toml")).texts["consent.text"] == "Yes?"


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("../secret.obj", None, "not a file beside the study"),
        ("pipe.obj", "pipe", "not a regular file"),
        ("a.obj", "mtllib ../../secret.mtl\nv 0 0 0\n", "names '../../secret.mtl': not a file"),
        ("a.obj", "mtllib /etc/passwd\n", "names '/etc/passwd': not a file beside"),
        ("b.obj", "mtllib b.mtl\n", "names 'b.mtl': not a file beside"),
        ("a.gltf", '{"buffers": [{"uri": "..\\u002f..\\u002fx"}]}', "names '../../x': not a file"),
        ("a.gltf", '{"images": [{"uri" : "%2e%2e/%2e%2e/x.png"}]}', "names '../../x.png': not a"),
        ("a.gltf", '{"images": [{"uri" : "pipe.obj"}]}', "names 'pipe.obj': not a regular file"),
    ],
)
def test_a_model_and_all_that_it_names_lie_beside_the_study(folder, name, content, said):
    os.mkfifo(folder / "pipe.obj")
    (folder.parent / "secret.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (folder / "b.mtl").write_text("newmtl a\nmap_Kd -s 1 1 1 ../../etc/secret.png\n")
    if content not in (None, "pipe"):
        (folder / name).write_text(content)
    study = copy.deepcopy(BASE)
    study["world"]["building"]["models"] = [{"name": "mine", "file": name}]
    (folder / "s.toml").write_text(toml(study), "utf-8")
    status, err, seconds = check(folder / "s.toml")
    assert status == 2 and err.count("\n") == 1 and seconds < QUICK
    assert "world.building.models[0].file = " in err and said in err


@pytest.mark.parametrize("name", ["pipe", "/dev/zero", "zero", "gone.txt"])
def test_a_study_is_a_regular_file(folder, name, monkeypatch):
    monkeypatch.chdir(folder)
    status, err, seconds = check(name)
    assert status == 2 and err.count("\n") == 1 and seconds < QUICK
    assert "cannot be read" in err


SLOW = {
    "a key of 50,000 names": ".".join("a" * 50_000) + " = 1\n" + RAW,
    "a table of 50,000 names": RAW + "\n[" + " . ".join("a" * 50_000) + "]\n",
    "quoted names": RAW + "\n[" + ".".join(['"a"'] * 50_000) + "]\n",
    "a seed of 5,000 digits": RAW.replace('"seed" = ', '"seed" = ' + "1" * 5000, 1),
    "a hexadecimal seed": RAW.replace('"seed" = ', '"seed" = 0x' + "f" * 50_000 + "\n#", 1),
    "a float of 5,000 digits": RAW.replace('"seed" = ', '"seed" = 0.' + "1" * 5000 + "\n#", 1),
    "an exponent": RAW.replace('"seed" = ', '"seed" = 1e' + "9" * 5000 + "\n#", 1),
    "arrays in arrays": RAW + "\nx = " + "[" * 100_000,
    "20,000 tables": RAW + "".join(f"[t{i}]\n" for i in range(20_000)),
    "fourteen million cells": RAW
    + "".join(
        f"[factors.f{i}]\nset = 'technique.dynamic.p{i}'\nvalues = [1, 2, 3]\n" for i in range(15)
    ),
    "20,000 keys": RAW + "".join(f"a{i} = 1\n" for i in range(20_000)),
    "two megabytes": "#" + "x" * 2**21 + "\n" + RAW,
    "escapes without an end": RAW + '\nx = """' + '\\"' * 100_000,
    "quotes": RAW + "\n" + '"' * 200_000,
    "apostrophes": RAW + "\n" + "'''a" * 50_000,
}


@pytest.mark.parametrize("name", SLOW)
def test_a_study_that_would_take_minutes_is_refused_at_once(tmp_path, name):
    (tmp_path / "s.toml").write_text(SLOW[name], "utf-8")
    status, err, seconds = check(tmp_path / "s.toml")
    assert status == 2 and seconds < QUICK
    assert all(line.startswith("seethrough: ") for line in err.splitlines())
    assert err.isprintable() or "\n" in err


def test_texts_and_comments_may_hold_what_keys_may_not(tmp_path):
    from seethrough.experiment.study.beside.toml_file import read_toml

    path = tmp_path / "s.toml"
    dots = ".".join("a" * 99)
    text = f'# {dots}\na = "{dots} {"1" * 999}"\nb = """{dots}\n"{dots}\\"""" # "\n'
    path.write_text(text, "utf-8")
    assert read_toml(path) == {"a": f"{dots} {'1' * 999}", "b": f'{dots}\n"{dots}"'}


@pytest.mark.parametrize("value", ["1" * 180, "-" + "9" * 180, "nan", "inf", "-inf", "1e999"])
def test_numbers_beyond_all_bounds_are_refused_in_every_field(tmp_path, value):
    """Of every number in the study one after the other: one line, whatever it is."""
    path = tmp_path / "s.toml"
    for name, table in BASE.items():
        for key, old in table.items() if isinstance(table, dict) else ():
            if isinstance(old, bool) or not isinstance(old, int | float):
                continue
            text = RAW.replace(f'"{key}" = {old!r}\n', f'"{key}" = {value}\n', 1)
            assert text != RAW, (name, key)
            path.write_text(text, "utf-8")
            status, err, _ = check(path)
            assert status == 2 and "Traceback" not in err and key in err, (name, key, err)
