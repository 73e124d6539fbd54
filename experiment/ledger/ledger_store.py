"""The ledger's tables, in SQLite or PostgreSQL. Only ledger*.py import SQLAlchemy.

Every change is one transaction that no other can overlap: SQLite's BEGIN IMMEDIATE, PostgreSQL's
advisory lock. A unique index besides makes two holders of a slot impossible.
"""

from __future__ import annotations

import os
import sqlite3
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import sqlalchemy as sql
from sqlalchemy.engine import URL, Connection, Engine, make_url
from sqlalchemy.exc import ArgumentError, DBAPIError, SQLAlchemyError

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.network_drive import network_drive
from seethrough.experiment.ledger.ledger_slots import COMPLETE, LIVE

DAMAGED = (
    "the ledger is damaged: put back a copy, or move it away and it is made again from the data"
)
WAIT = 30.0  # s that a station waits for the others' transactions; each takes milliseconds
PAUSE = 0.002  # s between two tries: the same for everybody, however long they have waited
LOCK = 0x5EE7  # PostgreSQL's advisory locks have numbers; this one is ours

METADATA = sql.MetaData()
STUDIES = sql.Table(
    "seethrough_studies",
    METADATA,
    sql.Column("name", sql.String(32), primary_key=True),
    sql.Column("digest", sql.String(64), nullable=False),
    sql.Column("resolved", sql.Text, nullable=False),
    sql.Column("rows", sql.Integer, nullable=False),
    sql.Column("participants", sql.Integer, nullable=False),
    sql.Column("stale_after", sql.Float, nullable=False),
    sql.Column("begun", sql.String(32), nullable=False),
)
ENTRIES = sql.Table(
    "seethrough_entries",
    METADATA,
    sql.Column("id", sql.Integer, primary_key=True),
    sql.Column("study", sql.ForeignKey(STUDIES.c.name), nullable=False),
    sql.Column("slot", sql.Integer, nullable=False),
    sql.Column("participant", sql.String(32), nullable=False),
    sql.Column("status", sql.String(8), nullable=False),
    sql.Column("reserved", sql.String(32), nullable=False),
    sql.Column("changed", sql.String(32), nullable=False),
    sql.Column("why", sql.Text, nullable=False),
    sql.UniqueConstraint("study", "participant"),
)
LOCKS = sql.Table(
    "seethrough_locks",
    METADATA,
    sql.Column("study", sql.String(32), primary_key=True),
    sql.Column("participant", sql.String(32), primary_key=True),
    sql.Column("token", sql.String(16), nullable=False),
    sql.Column("station", sql.Text, nullable=False),
    sql.Column("place", sql.Text, nullable=False),
    sql.Column("since", sql.String(32), nullable=False),
    sql.Column("beats", sql.Integer, nullable=False),
    sql.Column("heard", sql.Double, nullable=False),  # s, by the database's clock if it has one
)
SUMS = sql.Table(
    "seethrough_sums",
    METADATA,
    sql.Column("study", sql.String(32), primary_key=True),
    sql.Column("participant", sql.String(32), primary_key=True),  # "" for the study's own row
    sql.Column("sum", sql.String(64), nullable=False),
)
_HELD = ENTRIES.c.status.in_((LIVE, COMPLETE))
sql.Index(
    "seethrough_one_holder",
    ENTRIES.c.study,
    ENTRIES.c.slot,
    unique=True,
    sqlite_where=_HELD,
    postgresql_where=_HELD,
)


def sqlite_url(path: Path) -> URL:
    """The address of a SQLite file."""
    return URL.create("sqlite+pysqlite", database=str(path))


def parse_url(text: str) -> URL:
    """The address of a PostgreSQL database, with its driver. Raises InputError."""
    try:
        url = make_url(text)
    except (ArgumentError, ValueError):
        url = None
    if url is None or url.drivername not in ("postgresql", "postgresql+psycopg"):
        raise InputError(f"--ledger = {shown(url)}: expected postgresql://USER@HOST/DATABASE")
    return url.set(drivername="postgresql+psycopg")


def shown(url: URL | None) -> str:
    """An address for messages and files, without its password."""
    if url is None:
        return "…"  # what cannot be parsed may hold a password anywhere
    plain = URL.create("postgresql", url.username, None, url.host, url.port, url.database)
    query = {key: value for key, value in url.query.items() if "pass" not in key}
    return plain.set(query=query).render_as_string()


def connect(url: URL) -> Engine:
    """An engine whose transactions exclude each other, tables made. Raises InputError."""
    with errors(url):
        if url.get_backend_name() == "sqlite":
            engine = _sqlite(url)
        else:
            wait = {"connect_timeout": int(WAIT)}
            engine = sql.create_engine(url, connect_args=wait, pool_size=1, pool_pre_ping=True)
    try:
        with exclusive(engine) as connection:
            if url.get_backend_name() == "sqlite":
                _whole(connection, url)
            METADATA.create_all(connection)
    except BaseException:
        engine.dispose()
        raise
    return engine


def _whole(connection: Connection, url: URL) -> None:
    """Raises InputError for a damaged file, in SQLite's own words."""
    found = [str(row[0]) for row in connection.exec_driver_sql("PRAGMA integrity_check")]
    if found != ["ok"]:
        words = " ".join(found[0].split())
        raise InputError(f"{url.database}: {DAMAGED}: {words}")


def _sqlite(url: URL) -> Engine:
    assert url.database is not None
    _make_private(Path(url.database))
    engine = sql.create_engine(url, connect_args={"timeout": WAIT})

    # A write-ahead log needs memory that all stations share: over a network there is none.
    journal = "DELETE" if network_drive(Path(url.database)) else "WAL"

    @sql.event.listens_for(engine, "connect")
    def _(connection: sqlite3.Connection, _: object) -> None:
        connection.isolation_level = None  # the driver begins no transactions of its own
        for pragma in (f"journal_mode={journal}", "synchronous=FULL", "foreign_keys=ON"):
            connection.execute(f"PRAGMA {pragma}")

    @sql.event.listens_for(engine, "begin")
    def _(connection: Connection) -> None:
        _begin(connection)

    return engine


def _begin(connection: Connection) -> None:
    """Wait for the database and take it, as likely as any other station that waits.

    SQLite's own waiting grows to .1 s between tries, so that whoever has waited long hardly ever
    comes before those who ask anew: of eight busy stations some starve.
    """
    driver = connection.connection.driver_connection
    assert driver is not None
    driver.execute("PRAGMA busy_timeout=0")
    try:
        for left in reversed(range(round(WAIT / PAUSE))):
            try:
                driver.execute("BEGIN IMMEDIATE")
                return
            except sqlite3.OperationalError as error:
                if error.sqlite_errorcode & 0xFF != sqlite3.SQLITE_BUSY or not left:
                    raise
            time.sleep(PAUSE)
    finally:
        driver.execute(f"PRAGMA busy_timeout={round(WAIT * 1000)}")


def _make_private(path: Path) -> None:
    """SQLite's other files get the permissions of the first."""
    try:
        os.close(os.open(path, os.O_CREAT | os.O_RDWR, 0o600))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror}") from None


@contextmanager
def exclusive(engine: Engine) -> Iterator[Connection]:
    """A transaction that no other overlaps. Raises InputError where the database can't be used."""
    with errors(engine.url), engine.begin() as connection:
        if engine.dialect.name == "postgresql":
            connection.execute(sql.select(sql.func.pg_advisory_xact_lock(LOCK)))
        yield connection


@contextmanager
def errors(url: URL) -> Iterator[None]:
    """Turns the database's errors into one line that names the ledger."""
    where = url.database if url.get_backend_name() == "sqlite" else shown(url)
    try:
        yield
    except ModuleNotFoundError as error:
        raise InputError(
            f"{where}: needs the package {error.name}: pip install 'seethrough[stations]'"
        ) from None
    except (SQLAlchemyError, sqlite3.Error, UnicodeError) as error:
        reason = error.orig if isinstance(error, DBAPIError) else error
        words = " ".join(str(reason).split()).removeprefix("connection failed: ")
        raise InputError(f"{where}: the ledger cannot be used: {words}") from None
