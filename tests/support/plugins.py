"""A stranger's package, installed as one would be, and the program that finds it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

BUILD = "from setuptools import build_meta as b; b.build_wheel('built')"


def installed(package: Path, folder: Path) -> Path:
    """Build a package's wheel and install it below a folder. Returns where, for PYTHONPATH."""
    copy, there = folder / "copy", folder / "site"
    shutil.copytree(package, copy)
    _run([sys.executable, "-c", BUILD], copy)
    (wheel,) = (copy / "built").glob("*.whl")
    words = ["install", "--quiet", "--no-deps", "--no-index", f"--target={there}", str(wheel)]
    _run([sys.executable, "-m", "pip", *words], folder)
    return there


def seethrough(there: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run the program with what is installed there beside everything else."""
    environment = {**os.environ, "PYTHONPATH": str(there)}
    command = [sys.executable, "-m", "seethrough", *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)


def _run(command: list[str], folder: Path) -> None:
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
