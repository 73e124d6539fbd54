"""Typed columns for programs: each table as one Parquet file, written by DuckDB."""

from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from seethrough.analysis.files.written import FILE
from seethrough.experiment.errors import InputError
from seethrough.experiment.export.dataset import Dataset
from seethrough.experiment.files.private import make_folder
from seethrough.experiment.record.columns import Column, columns_in

TYPES = {"text": "VARCHAR", "integer": "BIGINT", "number": "DOUBLE", "boolean": "BOOLEAN"}
INSTALL = "pip install 'seethrough[parquet]'"
READ = """
SELECT {selected} FROM read_csv({files}, header = true, delim = ',', quote = '"', escape = '"',
      nullstr = '', parallel = false, auto_detect = false, columns = {columns})
"""
COPY = "COPY ({rows}) TO {out} (FORMAT parquet, COMPRESSION zstd)"


def parquet(data: Dataset, out: Path) -> None:
    """trials.parquet and its likes; what is empty is null. Raises InputError."""
    make_folder(out)
    try:
        with ParquetWriter() as writer:
            for table, paths in data.files.items():
                if paths:
                    writer.write(table, paths, out / f"{table}.parquet")
    except ModuleNotFoundError:
        raise InputError(f"--format = parquet: needs DuckDB: {INSTALL}") from None


class ParquetWriter:
    """Makes Parquet files of tables. Raises ModuleNotFoundError without DuckDB, an extra."""

    def __init__(self) -> None:
        import duckdb  # only this format needs it

        self._database = duckdb.connect(config={"threads": 1})  # opened once: it costs 0.1 s
        self._error = duckdb.Error

    def __enter__(self) -> ParquetWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self._database.close()

    def write(self, table: str, paths: Sequence[Path], target: Path) -> None:
        """One file of all rows of these files of a table. Raises InputError."""
        # Those from before a column was added (record/columns.py) lie in a run of their own.
        headers = [(path, _header(path)) for path in paths]
        columns = columns_in(table, headers[-1][1])
        runs = [
            _read(columns, [path for path, _ in run], names)
            for names, run in groupby(headers, itemgetter(1))
        ]
        query = COPY.format(rows=" UNION ALL ".join(runs), out=_text(str(target)))
        try:
            self._database.execute(query)
        except self._error as error:
            raise InputError(f"{target}: {' '.join(str(error).split())[:300]}") from None
        os.chmod(target, FILE)


def _header(path: Path) -> list[str]:
    """The names of a file's columns."""
    with open(path, encoding="utf-8") as file:
        return file.readline().rstrip("\n").split(",")


def _read(columns: Sequence[Column], paths: Sequence[Path], names: Sequence[str]) -> str:
    """A query for the rows of files that have the columns of these names."""
    there = [c for c in columns if c.name in names]
    typed = ", ".join(f"{_text(c.name)}: {_text(TYPES[c.type])}" for c in there)
    selected = ", ".join(
        f'"{c.name}"' if c in there else f'CAST(NULL AS {TYPES[c.type]}) AS "{c.name}"'
        for c in columns
    )
    files = "[" + ", ".join(_text(str(path)) for path in paths) + "]"
    return READ.format(selected=selected, files=files, columns="{" + typed + "}")


def _text(value: str) -> str:
    """A text in SQL."""
    return "'" + value.replace("'", "''") + "'"
