"""An older commit's code beside this one, for measurements against it."""

from __future__ import annotations

import io
import subprocess
import tarfile
import tempfile
from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

HERE = Path(__file__).resolve().parents[1]


@contextmanager
def both_trees(parser: ArgumentParser, commit: str) -> Iterator[tuple[Path, Path]]:
    """The folder of that commit's code, gone afterwards, and of this one. Ends the command through
    its `parser` where there is no such commit."""
    found = subprocess.run(["git", "archive", commit], cwd=HERE, capture_output=True)
    if found.returncode:
        parser.error(f"{commit}: {found.stderr.decode().strip()}; expected a commit")
    with tempfile.TemporaryDirectory() as folder:
        tarfile.open(fileobj=io.BytesIO(found.stdout)).extractall(folder, filter="data")
        yield Path(folder), HERE
