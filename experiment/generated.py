"""Pages that a command writes anew, and a test holds equal to what it would write."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path


def write_anew(page: Path, made: Callable[[], str], about: str) -> int:
    """Write a page; `about` says in `--help` what it is. Returns 0."""
    parser = argparse.ArgumentParser(description=f"Writes {page.name} anew. {about}")
    parser.parse_args()
    page.write_text(made(), "utf-8")
    sys.stdout.write(f"{page}\n")
    return 0
