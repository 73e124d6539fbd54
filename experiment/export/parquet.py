"""Typed columns for programs: each table as one Parquet file, written by DuckDB."""

from __future__ import annotations

import os
from pathlib import Path

from experiment.columns import TABLES
from experiment.errors import InputError
from experiment.export.dataset import Dataset
from experiment.private import FILE, make_folder

TYPES = {"text": "VARCHAR", "integer": "BIGINT", "number": "DOUBLE", "boolean": "BOOLEAN"}
COPY = """
COPY (SELECT * FROM read_csv({files}, header = true, delim = ',', quote = '"', escape = '"',
      nullstr = '', parallel = false, auto_detect = false, columns = {columns}))
TO {out} (FORMAT parquet, COMPRESSION zstd)
"""


def parquet(data: Dataset, out: Path) -> None:
    """trials.parquet and its likes; what is empty is null. Raises InputError."""
    try:
        import duckdb  # an extra: only this format needs it
    except ModuleNotFoundError:
        raise InputError(
            "--format = parquet: needs DuckDB: pip install 'seethrough[parquet]'"
        ) from None
    make_folder(out)
    for table, paths in data.files.items():
        if not paths:
            continue
        target = out / f"{table}.parquet"
        columns = ", ".join(f"{_text(c.name)}: {_text(TYPES[c.type])}" for c in TABLES[table])
        files = "[" + ", ".join(_text(str(path)) for path in paths) + "]"
        query = COPY.format(files=files, columns="{" + columns + "}", out=_text(str(target)))
        try:
            with duckdb.connect() as database:
                database.execute(query)
        except duckdb.Error as error:
            raise InputError(f"{target}: {' '.join(str(error).split())[:300]}") from None
        os.chmod(target, FILE)


def _text(value: str) -> str:
    """A text in SQL."""
    return "'" + value.replace("'", "''") + "'"
