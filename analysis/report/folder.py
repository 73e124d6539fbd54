"""The folder that a report goes into: new, empty, or with an earlier report to replace."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from seethrough.analysis.errors import DataError

PAGES = ("report.html", "report.md", "report.pdf", "analysis.R")
PARTS = {"tables": (".csv",), "figures": (".svg", ".png", ".pdf")}
MARK = b"seethrough report"


def earlier(out: Path, replace: bool) -> list[Path]:
    """The files of the report that is there, to be removed when the new one is made.

    Raises DataError where there is one and it is not to be replaced, or where anything else lies
    there: that is never touched.
    """
    if not out.exists():
        return []
    if not out.is_dir():
        raise DataError(f"--out = {out}: expected a folder, this is a file")
    there = sorted(out.iterdir())
    if not there:
        return []
    page = out / PAGES[0]
    if not (page.is_file() and MARK in page.read_bytes()):
        raise DataError(f"--out = {out}: not empty and no earlier report: expected a new folder")
    if not replace:
        raise DataError(
            f"--out = {out}: holds a report already: expected another folder, or --replace"
        )
    found = [path for top in there for path in (_inside(top) if top.name in PARTS else [top])]
    if other := next((path for path in found if not _ours(path, out)), None):
        raise DataError(
            f"--replace = {out}: holds {other.relative_to(out)}, which is no part of a report: "
            "expected another folder"
        )
    return found


def clear(files: Sequence[Path]) -> None:
    """Remove the earlier report."""
    for path in files:
        path.unlink()


def _inside(folder: Path) -> list[Path]:
    return sorted(folder.iterdir()) if folder.is_dir() and not folder.is_symlink() else [folder]


def _ours(path: Path, out: Path) -> bool:
    """Whether a report has a file of that name, and its page or tables say so."""
    if not path.is_file() or path.is_symlink():
        return False
    if path.parent == out:
        return path.name in PAGES
    if path.suffix not in PARTS[path.parent.name]:
        return False
    page = (out / PAGES[0]).read_text("utf-8", "replace")
    return f"{path.parent.name}/{path.stem}." in page
