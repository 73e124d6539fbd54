"""The growing files of a session: tables of whole, fsynced rows, and a trial's traces.

A disk that fills up or goes away becomes one line (InputError); what was completed before stays
whole, a row that could not be written whole is taken back.
"""

from __future__ import annotations

import csv
import hashlib
import io
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

import numpy as np

from seethrough.analysis.files.written import FILE
from seethrough.experiment.files.private import refused, sync_folder, write, write_new
from seethrough.experiment.record.chain import link
from seethrough.experiment.record.columns import Column
from seethrough.renderer.events import Event, Tick
from seethrough.tasks.kit.base import View

EVENTS = "time,event,x,y,dx,dy,dragging,key,within"
CHUNK = 1 << 16  # bytes of traces that are kept before they are written


def ask_again(guard: Callable[[], None], take_back: Callable[[], None]) -> None:
    """Ask once more after a write: this may have stood still since it asked before, and been taken
    over. Then what was written is taken back, for somebody has gone on without it."""
    try:
        guard()
    except BaseException:
        with suppress(OSError):  # the disk is gone as well: nothing can be taken back
            take_back()
        raise


class Table:
    """A CSV file that grows by whole, fsynced rows; `chain` starts its last column, if given."""

    def __init__(
        self,
        path: Path,
        columns: tuple[Column, ...],
        chain: str | None = None,
        guard: Callable[[], None] = lambda: None,
    ) -> None:
        """`guard` is called before each write, and raises where nothing may be written."""
        self.path, self._guard = path, guard
        self.chain = chain
        self._names = [c.name for c in columns]
        guard()
        write_new(path, header_of(columns) + "\n")
        ask_again(guard, path.unlink)
        self._file: int | None = os.open(path, os.O_WRONLY | os.O_APPEND)

    def append(self, *rows: Mapping[str, object]) -> None:
        """Rows at once; columns that are not given stay empty. Unknown columns raise KeyError."""
        lines, value = [], self.chain
        for row in rows:
            unknown = set(row) - set(self._names)
            if unknown:
                raise KeyError(f"columns not declared: {sorted(unknown)}")
            cells = [cell(row.get(name)) for name in self._names]
            if value is None:
                lines.append(csv_line(cells))
                continue
            text = csv_line(cells[:-1])
            value = link(value, text)
            lines.append(f"{text},{value}")
        self._write("".join(f"{line}\n" for line in lines))
        self.chain = value

    def _write(self, text: str) -> None:
        file = self._file
        assert file is not None
        self._guard()
        size = os.fstat(file).st_size
        try:
            write(file, text.encode("utf-8", "replace"))
            os.fsync(file)
        except OSError as error:
            with suppress(OSError):  # the disk is gone altogether: nothing can be taken back
                os.ftruncate(file, size)
            raise refused(error, self.path) from None
        ask_again(self._guard, lambda: os.ftruncate(file, size))

    def close(self) -> None:
        """Closing twice does no harm."""
        if self._file is not None:
            os.close(self._file)
            self._file = None


class Trace:
    """A file that is written in pieces and hashed on the way."""

    def __init__(self, path: Path, header: str, guard: Callable[[], None] = lambda: None) -> None:
        self.path, self._guard = path, guard
        self._hash = hashlib.sha256()
        self._kept: list[str] = [header]
        self._size = 0
        try:
            self._file: int | None = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, FILE)
        except OSError as error:
            raise refused(error, path) from None
        ask_again(guard, self._unmake)

    def line(self, text: str) -> None:
        """One line more."""
        self._kept.append(text)
        self._size += len(text)
        if self._size > CHUNK:
            self._write()

    def close(self) -> None:
        """On disk when this returns; closing twice does no harm."""
        if self._file is None:
            return
        try:
            self._write()
            os.fsync(self._file)
        except OSError as error:
            raise refused(error, self.path) from None
        finally:
            os.close(self._file)
            self._file = None

    @property
    def sha256(self) -> str:
        """Of what was written."""
        return self._hash.hexdigest()

    def _unmake(self) -> None:
        assert self._file is not None
        os.close(self._file)
        self.path.unlink()

    def _write(self) -> None:
        file = self._file
        assert file is not None
        self._guard()
        size = os.fstat(file).st_size
        data = "".join(f"{line}\n" for line in self._kept).encode("utf-8", "replace")
        self._kept.clear()
        self._size = 0
        try:
            write(file, data)
        except OSError as error:
            raise refused(error, self.path) from None
        ask_again(self._guard, lambda: os.ftruncate(file, size))
        self._hash.update(data)


class Traces:
    """What happened between a trial's first frame and its end, in two files of its own."""

    def __init__(self, folder: Path, name: str, guard: Callable[[], None] = lambda: None) -> None:
        self.events = Trace(folder / f"{name}_events.csv", EVENTS, guard)
        eye, forward = "eye_x,eye_y,eye_z", "forward_x,forward_y,forward_z"
        self.camera = Trace(folder / f"{name}_camera.csv", f"time,{eye},{forward},digest", guard)
        self._last_camera: object = None

    def event(self, event: Event) -> None:
        """One input event."""
        if isinstance(event, Tick):
            kind, rest = "tick", ",,,,,,"
        else:
            values = asdict(event)
            kind = type(event).__name__
            names = ("x", "y", "dx", "dy", "dragging", "key")
            # Where the time is known, the last cell is empty.
            rest = ",".join([*(cell(values.get(n)) for n in names), cell(event.within or None)])
        self.events.line(f"{cell(event.time)},{kind},{rest}")

    def frame(self, time: float, view: View, digest: str) -> None:
        """One frame; a camera that stands is written once."""
        camera = view.camera
        values = [] if camera is self._last_camera else [*camera.eye, *camera.forward]
        cells = [repr(float(v)) for v in values] or [""] * 6
        self.camera.line(",".join([repr(float(time)), *cells, digest]))
        self._last_camera = camera

    def close(self) -> None:
        """Both files are on disk; closing twice does no harm."""
        try:
            self.events.close()
        finally:
            self.camera.close()
        sync_folder(self.events.path.parent)  # their names too


def header_of(columns: tuple[Column, ...]) -> str:
    """A table's first line."""
    return ",".join(c.name for c in columns)


def cell(value: object) -> str:
    """A value as its column's type is written (CONVENTIONS.md, tables)."""
    if value is None:
        return ""
    if isinstance(value, np.generic):
        value = value.item()  # its own repr names its type
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return repr(value)
    # A null byte ends the text for some readers of CSV.
    return str(value).replace("\0", "�")


def csv_line(cells: list[str]) -> str:
    """A row, quoted where it must be, without its line's end."""
    text = io.StringIO()
    # Before Python 3.13 a line break is quoted only where it is part of the line's end.
    csv.writer(text, lineterminator="\r\n").writerow(cells)
    return text.getvalue()[:-2]


def whole_rows(data: bytes) -> int:
    """Bytes of a table's whole rows: the line breaks in a quoted text end no row."""
    end = len(data)
    while (at := data.rfind(b"\n", 0, end)) >= 0:
        if data.count(b'"', 0, at) % 2 == 0:
            return at + 1
        end = at
    return 0


def mend(folder: Path) -> dict[str, int]:
    """Cut off rows that a crash left half-written: {file: bytes cut}. Raises OSError."""
    cut = {}
    for path in sorted(folder.glob("*_data.csv")):
        data = path.read_bytes()
        whole = whole_rows(data)
        if whole < len(data):
            os.truncate(path, whole)
            cut[path.name] = len(data) - whole
    return cut
