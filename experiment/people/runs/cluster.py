"""The same work on a Dask cluster: results in the order of the items, whoever made them.

Workers get study and tables as values: they share no disk with this machine. Dask hands the
chunks of a worker that died to another one.
"""

from __future__ import annotations

import hashlib
import logging
import pickle
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from importlib import metadata
from threading import Lock
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError
from seethrough.experiment.people.code_hash import code_sha256
from seethrough.experiment.people.runs import batch as b
from seethrough.experiment.people.runs.batch_files import Chunk, Slots, chunk_name
from seethrough.experiment.people.runs.looks import KeptLooks
from seethrough.experiment.study.config import Study, load

if TYPE_CHECKING:
    from distributed import Client, Future

PATIENCE = 5.0  # seconds until a scheduler or workers that do not answer are not there
AHEAD = 2  # chunks handed out for each thread of the cluster, so that none waits
PACKAGES = ("seethrough", "numpy")  # whose versions a chunk's sidecar holds
MOST_LOSSES = 20  # of the scattered tables, with the workers that held them

_one_at_a_time = Lock()  # participants of one process share its tables
_prepared: list[str] = []  # the run that this process is ready for


def play(job: b.Batch, chunks: Sequence[Slots], address: str) -> Iterator[Chunk]:
    """`batch.play_files` of each chunk, in order.

    Raises InputError where no scheduler or no worker answers, where workers are of another
    version or keep dying.
    """
    try:
        from distributed import Client, KilledWorker  # an extra: only this option needs it
    except ModuleNotFoundError:
        raise InputError("--scheduler: needs Dask: pip install 'seethrough[cluster]'") from None
    # What Dask says about lost workers and schedulers in many lines is said in one here.
    logging.getLogger("distributed").setLevel(logging.CRITICAL + 1)
    study = load(job.study)
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise InputError(
            f"--scheduler = {address}: no Dask scheduler answers: {_said(error)}"
        ) from None
    with client:
        try:
            yield from _Queue(client, job, study, chunks)
        except KilledWorker:
            raise InputError(f"--scheduler = {address}: its workers die one by one") from None
        except ModuleNotFoundError as error:
            raise InputError(
                f"--scheduler = {address}: its workers need this version of seethrough: {error}"
            ) from None
        except InputError as error:
            raise InputError(f"--scheduler = {address}: {error}") from None
        except OSError as error:  # time-outs and lost connections are such
            raise InputError(
                f"--scheduler = {address}: no worker answers: {_said(error)}"
            ) from None


def _said(error: Exception) -> str:
    return " ".join(str(error).split())[:120] or type(error).__name__


class _Queue:
    """Chunks in the hands of the cluster, the oldest first."""

    def __init__(self, client: Client, job: b.Batch, study: Study, chunks: Sequence[Slots]) -> None:
        self._client, self._chunks = client, iter(chunks)
        self._needs = {**_versions(), "code": job.code}
        self._job = pickle.dumps((replace(job, tables=None), study))
        self._tables = b""
        if job.tables is not None:
            with closing(KeptLooks(job.tables)) as looks:
                self._tables = looks.whole()
        self._waiting: deque[tuple[Slots, Future[Chunk]]] = deque()
        self._scattered = self._scatter()

    def __iter__(self) -> Iterator[Chunk]:
        losses = 0
        while self._fill():
            slots, future = self._waiting[0]
            error = future.exception()
            if error is None or not _is_lost(error):
                yield future.result()
                self._waiting.popleft()
                continue
            losses += 1
            if losses > MOST_LOSSES:
                raise InputError(f"{chunk_name(slots)} was lost with its workers again and again")
            self._again()

    def _scatter(self) -> list[Future[bytes]]:
        sent: list[Future[bytes]] = self._client.scatter([self._job, self._tables], broadcast=True)
        return sent

    def _submit(self, slots: Slots) -> Future[Chunk]:
        return self._client.submit(_work, self._needs, *self._scattered, slots, pure=False)

    def _fill(self) -> bool:
        """Hand out more; whether anything is on its way."""
        most = AHEAD * max(1, sum(self._client.nthreads().values()))
        while len(self._waiting) < most and (slots := next(self._chunks, None)) is not None:
            self._waiting.append((slots, self._submit(slots)))
        return bool(self._waiting)

    def _again(self) -> None:
        """The tables died with the last worker that held them: send them and the chunks again."""
        self._scattered = self._scatter()
        self._waiting = deque((slots, self._submit(slots)) for slots, _ in self._waiting)


def _is_lost(error: BaseException) -> bool:
    from distributed.client import FutureCancelledError

    return isinstance(error, FutureCancelledError)


def _versions() -> dict[str, str]:
    """What must be the same in every process for the rows to be the same."""
    return {**{name: metadata.version(name) for name in PACKAGES}, "code": code_sha256()}


def _work(needs: Mapping[str, str], job: bytes, tables: bytes, slots: Slots) -> Chunk:
    """Runs in a worker's process. Raises InputError where that is of another version."""
    here = _versions()
    for name, version in needs.items():
        if here.get(name) != version:
            raise InputError(f"a worker has {name} {here.get(name)}: expected {version}, as here")
    run = hashlib.sha256(job).hexdigest()
    with _one_at_a_time:
        if _prepared != [run]:
            batch, study = pickle.loads(job)
            b.prepare(batch, study, tables)
            _prepared[:] = [run]
        return b.play_files(slots)
