"""The wheel, installed in an empty environment and run from another folder."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
NOT_OURS = shutil.ignore_patterns(".*", "__pycache__", "*.nbi", "*.nbc", "out", "dist", "build")
PLANTED = Path("data/human/P01/study-demo_subject-P01_session-1_trials_data.csv")

Seethrough = Callable[..., subprocess.CompletedProcess[str]]


ROOMS = ("analysis", "benchmarks", "configs", "experiment", "renderer", "tasks")
BUILD = "from setuptools import build_meta as b; b.build_sdist('built'); b.build_wheel('built')"


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the wheel and the sdist of a copy of the tree, in which a participant's file
    lies that no .gitignore hides."""
    copy = tmp_path_factory.mktemp("build") / "tree"
    shutil.copytree(ROOT, copy, ignore=lambda d, names: NOT_OURS(d, names) | {"data"} & {*names})
    (copy / PLANTED).parent.mkdir(parents=True)
    (copy / PLANTED).write_text("row_id\n1\n", "utf-8")
    command = [sys.executable, "-c", BUILD]
    run = subprocess.run(command, cwd=copy, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    return copy / "built"


@pytest.fixture(scope="module")
def seethrough(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Seethrough:
    """Runs the installed program in an environment that has our wheel and, from the running one,
    what it depends on: its folder is on the path, the editable project in it is not."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", folder], check=True)
    python = folder / ("Scripts" if sys.platform == "win32" else "bin") / "python"
    (wheel,) = built.glob("*.whl")
    install = ["install", "--quiet", "--no-deps", "--no-index", str(wheel)]
    subprocess.run([sys.executable, "-m", "pip", f"--python={python}", *install], check=True)
    there = Path(sysconfig.get_path("purelib", "venv", {"base": str(folder)}))
    (there / "dependencies.pth").write_text(sysconfig.get_path("purelib") + "\n", "utf-8")
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "DISPLAY")}
    environment["NUMBA_DISABLE_JIT"] = "1"  # to compile everything anew takes half a minute

    def run(*words: str) -> subprocess.CompletedProcess[str]:
        command = [str(python.with_name("seethrough")), *words]
        return subprocess.run(
            command, cwd=elsewhere, env=environment, capture_output=True, text=True, check=False
        )

    return run


def _names(built: Path) -> tuple[set[str], set[str]]:
    """What the wheel holds, and what the sdist holds below its own folder."""
    (wheel,), (sdist,) = built.glob("*.whl"), built.glob("*.tar.gz")
    with zipfile.ZipFile(wheel) as archive:
        in_wheel = set(archive.namelist())
    with tarfile.open(sdist) as archive:
        in_sdist = {m.name.partition("/")[2] for m in archive.getmembers() if m.isfile()}
    return in_wheel, in_sdist


def test_the_wheel_holds_our_packages_whole(built: Path) -> None:
    """Every file of every package, shaders, configs and texts among them, and nothing else."""
    tree = built.parent
    ours = {
        path.relative_to(tree).as_posix().removeprefix("seethrough/")
        for room in ("seethrough", *ROOMS)
        for path in (tree / room).rglob("*")
        if path.is_file()
    }
    in_wheel, _ = _names(built)
    assert {n for n in in_wheel if ".dist-info/" not in n} == {f"seethrough/{n}" for n in ours}
    assert {"configs/published.toml", "configs/demo.toml", "renderer/shaders/object.frag"} <= ours
    assert any(name.endswith(".dist-info/licenses/LICENSE") for name in in_wheel)


def test_no_data_leave_the_machine(built: Path) -> None:
    """A participant's file lies in the tree, and neither in the wheel nor in the sdist."""
    assert (built.parent / PLANTED).exists()
    for names in _names(built):
        assert len(names) > 20
        assert not [name for name in names if name.startswith("data/")]
        assert not [name for name in names if name.endswith(PLANTED.name)]


def test_the_program_answers(seethrough: Seethrough) -> None:
    """`seethrough --help` lists the commands."""
    run = seethrough("--help")
    assert run.returncode == 0, run.stderr
    assert {"run", "simulate", "report", "check", "render", "demo"} <= {*run.stdout.split()}


def test_a_shipped_study_is_found_and_valid(seethrough: Seethrough) -> None:
    """Its config and texts come from the wheel."""
    run = seethrough("check", "demo", "--config-only")
    assert run.returncode == 0, run.stderr
    assert run.stdout.startswith("config      demo, ")
    assert run.stdout.splitlines()[-1].startswith("verdict     0 failures")


def test_bad_input_is_one_line(seethrough: Seethrough) -> None:
    """Exit status 2 and no traceback."""
    run = seethrough("check", "nowhere.toml")
    assert run.returncode == 2
    assert len(run.stderr.splitlines()) == 1
    assert "nowhere.toml" in run.stderr


def test_a_picture_is_drawn_with_the_shaders_of_the_wheel(
    seethrough: Seethrough, tmp_path: Path
) -> None:
    """`seethrough render` writes a PNG file of a scene, not of one colour."""
    picture = tmp_path / "picture.png"
    run = seethrough("render", "abstract", "--technique", "dynamic", "--out", str(picture))
    assert run.returncode == 0, run.stderr
    with Image.open(picture) as image:
        assert image.format == "PNG"
        assert len(image.convert("RGB").getcolors(2**24)) > 100
