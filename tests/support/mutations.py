r"""Changes the code in one place at a time and asks whether a test notices.

    .venv/bin/python tests/support/mutations.py --sites 120 --seed 1 [--since COMMIT] [--out FILE]

Sites are drawn from all places in the rooms where an operator applies (a comparison turned or made
strict, arithmetic or a sign exchanged, a constant moved, a condition negated or taken away, a call
left out, arguments exchanged, a return without its value), as many in each room; `--listed FILE`
tries changes made by hand instead (mutation_sites.py, `listed`). Each is tried in a copy of the
checkout, on the files of tests nearest to it by who imports whom, `--near` of them; if they pass,
on the next `--wide`. The first failure ends it. A test that takes over LIMIT hangs, which is a
failure; when `--budget` seconds are over, what has not failed has survived.

Every site has a process of its own, split off one that holds the libraries (importing them takes
longest). Kernels are compiled anew where the changed file is in them, and only there; others are
taken from the checkout, so run its tests of pictures before. A test that fails catches nothing
unless it passes in an unchanged copy. Prints a line a site, then what was
caught in each room and what survived; exit status 0.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from queue import Queue

import pytest
from mutation_sites import ROOMS, Site, drawn, listed
from nearest_tests import Imports

ROOT = Path(__file__).resolve().parents[2]
LIMIT = 90  # s for one test, with what its module makes first; none takes a third of it alone
LIBRARIES = ["numpy", "scipy.stats", "pandas", "numba", "moderngl", "matplotlib.pyplot"]
SAID = "said.txt"  # what the tests of a copy print
FORK = multiprocessing.get_context("forkserver")


class Told:
    """A plugin of pytest that tells another process which test runs and which fails."""

    def __init__(self, to: Connection) -> None:
        self.to = to

    def pytest_configure(self) -> None:
        """A first failure will do: hypothesis looks minutes for the simplest."""
        from hypothesis import Phase, settings

        once = (Phase.explicit, Phase.generate)
        settings.register_profile("once", phases=once, database=None)
        settings.load_profile("once")

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """A test begins."""
        self.to.send(("runs", nodeid))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """A test, its setup or its teardown ended."""
        if report.failed:
            self.to.send(("failed", report.nodeid))

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """A file was imported."""
        if report.failed:
            self.to.send(("failed", report.nodeid))


def _test(to: Connection, copy: Path, words: list[str], cache: str) -> None:
    """Run pytest on a copy of the checkout, in a process of its own."""
    os.setsid()
    os.chdir(copy)
    said = os.open(copy / SAID, os.O_RDWR | os.O_CREAT | os.O_TRUNC)
    for number in (0, 1, 2):
        os.dup2(said, number)
    # the folder one is in comes in no case first: its `seethrough` has no rooms, and the finder of
    # the checkout's would take them from there
    linked = str(copy / "linked")
    os.environ.update(
        PYTHONPATH=linked, PYTHONSAFEPATH="1", PYTHONDONTWRITEBYTECODE="1", NUMBA_CACHE_DIR=cache
    )
    sys.dont_write_bytecode = True
    sys.path[:] = [linked, *(p for p in sys.path if Path(p).resolve() != ROOT / "tests/support")]
    import numba

    numba.config.CACHE_DIR = cache  # read when numba was imported, before there was this one
    import seethrough.renderer

    assert Path(seethrough.renderer.__file__).is_relative_to(copy)
    options = ["-x", "-q", "-n0", "-p", "no:cacheprovider", "--no-header", "--tb=no"]
    to.send(("ended", int(pytest.main([*options, *words], plugins=[Told(to)]))))


def failed(copy: Path, words: list[str], cache: str, budget: float) -> tuple[str, str]:
    """What the first failure was (`failed`, `hangs`, `died`), or `passed` or `late`; and whose.

    Raises RuntimeError where the process ends before any test begins.
    """
    mine, its = FORK.Pipe(duplex=False)
    process = FORK.Process(target=_test, args=(its, copy, words, cache))
    process.start()
    its.close()
    until, since, test = time.monotonic() + budget, time.monotonic(), ""
    try:
        while True:
            left = min(until, since + LIMIT) - time.monotonic()
            if left <= 0 or not mine.poll(left):
                return ("late" if until < since + LIMIT else "hangs"), test
            try:
                what, value = mine.recv()
            except EOFError:
                if not test:
                    said = (copy / SAID).read_text("utf-8", "replace")
                    raise RuntimeError(f"no test began: {said[-2000:]}") from None
                return "died", test
            if what == "failed":
                return "failed", value
            if what == "ended":  # all passed, nothing was collected, or it could not even begin
                return ("passed", "") if value in (0, 5) else ("failed", words[0])
            test, since = value, time.monotonic()
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)  # and what the tests started
        except ProcessLookupError:  # it has ended, or has not made its group yet
            process.kill()
        process.join()


def copied(to: Path) -> None:
    """A copy of the checkout as it is now, with what it compiled, whose rooms lie in
    `linked/seethrough` for Python."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout
    for name in filter(None, names.decode().split("\0")):
        if (ROOT / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, to / name)
    linked = to / "linked" / "seethrough"
    linked.mkdir(parents=True)
    for source in (to / "seethrough").glob("*.py"):
        (linked / source.name).symlink_to(source)
    for room in (p for p in to.iterdir() if (p / "__init__.py").exists()):
        if room.name not in ("seethrough", "tests"):
            (linked / room.name).symlink_to(room, target_is_directory=True)
    kernels_of(to).mkdir()
    for kernel in ROOT.glob("renderer/**/__pycache__/*.nb[ci]"):
        its = kernel.parent.parent.relative_to(ROOT) / "any.py"
        (kernels_of(to) / _place(to, str(its))).mkdir(exist_ok=True)
        shutil.copy2(kernel, kernels_of(to) / _place(to, str(its)))


@dataclass
class Trials:
    """What is needed to try sites: who imports whom, how many files of tests to try and for how
    long, where compiled kernels are kept, and which tests fail without any change."""

    imports: Imports
    near: int
    wide: int
    budget: float
    useless: set[str]

    def row(self, site: Site, copy: Path) -> dict[str, str]:
        """Try a site: its line, what became of it, and by which test."""
        tests = self.imports.nearest(site.path)
        file = copy / site.path
        source = file.read_text("utf-8")
        stages = [tests[: self.near], tests[self.near : self.near + self.wide]]
        verdict, by = "NO TEST", ""
        began = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="numba-") as folder:
            cache = self._cache(site, copy, Path(folder) / "cache")
            try:
                file.write_text(site.applied(source), "utf-8")
                for stage in filter(None, stages):
                    left = self.budget - (time.monotonic() - began)
                    words = stage + [f"--deselect={test}" for test in sorted(self.useless)]
                    how, by = failed(copy, words, cache, left)
                    verdict = "SURVIVED" if how in ("passed", "late") else "caught"
                    if verdict == "caught" or how == "late":
                        break
            finally:
                file.write_text(source, "utf-8")
        told, took = site.told(ROOT), time.monotonic() - began
        print(f"{verdict:9}{took:4.0f} s {told}  [{how if tests else ''} {by}]", flush=True)
        return {"room": site.room, "site": told, "verdict": verdict, "by": by, "how": how}

    def _cache(self, site: Site, copy: Path, folder: Path) -> str:
        """Where kernels lie while a site is tried.

        numba compiles a kernel anew if its own file changed, but not if one did whose kernels or
        constants it took in. So where kernels can hold the change, they lie in a folder of their
        own, with links to all there are but those of the files that come to use the changed one.
        """
        warm = kernels_of(copy)
        users, todo = {site.path}, [site.path]
        while todo:
            for user in self.imports.users.get(todo.pop(), ()):
                if user not in users and not user.startswith("tests/"):
                    users.add(user)
                    todo.append(user)
        changed = [user for user in users if "njit" in self.imports.text[user]]
        if not changed or not site.compiled:
            return str(warm)
        shutil.copytree(warm, folder, copy_function=os.link)
        for user in changed:
            own = folder / _place(copy, user)
            for kernel in own.glob(f"{Path(user).stem}.*"):
                kernel.unlink()
        return str(folder)


def kernels_of(copy: Path) -> Path:
    """Where a copy's compiled kernels lie."""
    return copy.parent / f"{copy.name}-kernels"


def _place(copy: Path, path: str) -> str:
    """The folder, in a cache of numba's, of a copy's file."""
    from numba.core.caching import _CacheLocator

    return str(_CacheLocator.get_suitable_cache_subpath(str(copy / "linked/seethrough" / path)))


def main() -> None:
    """The command of the module's text."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--sites", type=int, default=120)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--since", default="", help="a commit: draw from lines newer than it")
    parser.add_argument("--listed", type=Path, help="a file of changes made by hand")
    parser.add_argument("--first", type=int, default=0, help="go on with this one of them, from 0")
    parser.add_argument("--near", type=int, default=4)
    parser.add_argument("--wide", type=int, default=12)
    parser.add_argument("--budget", type=float, default=240.0)
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument("--out", type=Path)
    args = parser.parse_args()
    print(f"seed {args.seed}" if args.listed is None else args.listed, flush=True)
    chosen = (
        drawn(args.sites, args.seed, ROOT, args.since)
        if args.listed is None
        else listed(args.listed, ROOT)
    )
    chosen = chosen[args.first :]
    FORK.set_forkserver_preload(LIBRARIES)
    trials = Trials(Imports(ROOT), args.near, args.wide, args.budget, set())
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(args.workers) as pool:
        copies: Queue[Path] = Queue()
        for k in range(args.workers):
            copied(Path(folder) / str(k))
            copies.put(Path(folder) / str(k))

        def one(site: Site) -> dict[str, str]:
            copy = copies.get()
            try:
                return trials.row(site, copy)
            finally:
                copies.put(copy)

        rows = list(pool.map(one, chosen))
        _doubt(rows, chosen, trials, Path(folder) / "0")
    for room in ROOMS:
        its = [row["verdict"] for row in rows if row["room"] == room]
        if its:
            print(f"{room}: {its.count('caught')} of {len(its)} caught")
    number = sum(row["verdict"] == "caught" for row in rows)
    print(f"{number} of {len(rows)} caught: {number / len(rows):.1%}; others:")
    print(*(row["site"] for row in rows if row["verdict"] != "caught"), sep="\n")
    if args.out:
        args.out.write_text(json.dumps(rows, indent=1), "utf-8")


def _doubt(rows: list[dict[str, str]], chosen: list[Site], trials: Trials, copy: Path) -> None:
    """Try again, without them, what was caught by tests that fail without the change as well."""
    good: set[str] = set()
    while todo := sorted({r["by"] for r in rows if r["verdict"] == "caught"} - good):
        while todo:
            how, by = failed(copy, todo, str(kernels_of(copy)), 3600.0)
            if how == "passed":
                break
            if by not in todo:
                raise RuntimeError(f"{how} in an unchanged copy: {by or todo}")
            print(f"{how} unchanged, too: {by}", flush=True)
            trials.useless.add(by)
            todo.remove(by)
        good |= set(todo)
        for k, row in enumerate(rows):
            if row["by"] in trials.useless:
                rows[k] = trials.row(chosen[k], copy)


if __name__ == "__main__":
    main()
