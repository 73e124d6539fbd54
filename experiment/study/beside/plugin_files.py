"""Plug-ins that one study brings along, a file each beside it: `[task.nearer] file = "nearer.py"`.

They are code, so they run only once somebody trusts them (trust.py), and they are taken only if
their kind's suite finds nothing. The data folder keeps each as it was, for replays.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

from seethrough import registry
from seethrough.experiment.errors import InputError, gathered, one_line, shown
from seethrough.experiment.files import trust
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.study.beside.study_files import LARGEST_TEXT, read_beside, read_regular
from seethrough.experiment.study.tables.plugins import taken_names

KINDS = ("technique", "world", "task", "question")
FOLDER = "plugins"  # in a data folder
SUITE_LIMIT = 300.0  # s, for all rules: the longest of ours takes a tenth of that


@dataclass(frozen=True)
class PluginFile:
    """A plug-in's file: its kind and name, what it is called beside the study, and its bytes."""

    kind: str
    name: str
    file: str
    content: bytes

    @property
    def sha256(self) -> str:
        """The hash that tells whether it is as it was."""
        return hashlib.sha256(self.content).hexdigest()


def taken(table: Mapping[str, object], path: Path) -> dict[str, object]:
    """The study's table without the entries that name files of plug-ins, which are known from now
    on. Raises InputError: of each that cannot be taken, where and why."""
    plain = {name: own for name, own in table.items() if name not in ("question", "plugins")}
    faults = [f"{path}: translations: unknown key; a language is named as study.language"] * (
        "translations" in table
    )
    faults += [f"{path}: plugins: unknown key; code is named where it is used, as "
              '[task.mine] file = "mine.py"'] * ("plugins" in table)  # fmt: skip
    for kind, name, file in _named(table):
        where = f"{path}: {kind}.{name}.file = {shown(file)}"
        if name in taken_names(kind):
            faults.append(f"{where}: expected another name than {name}, a study says other things "
                          "by it")  # fmt: skip
            continue
        try:
            _take(PluginFile(kind, name, file, _read(path, where, file)), path.parent / file, where)
        except InputError as error:
            faults += error.faults
        section = plain.get(kind, table[kind])
        own = {k: v for k, v in _table(_table(section)[name]).items() if k != "file"}
        if kind == "question":
            faults += [f"{path}: question.{name}.{k}: expected `file` alone; its keys stand in "
                       "[questions]" for k in own]  # fmt: skip
        else:
            plain[kind] = {**_table(section), name: own}
    faults += _strange(table.get("question", {}), path)
    if faults:
        raise gathered(faults)
    return plain


def _table(value: object) -> Mapping[str, object]:
    """A table, or an empty one where it is something else."""
    return value if isinstance(value, Mapping) else {}


def _named(table: Mapping[str, object]) -> Iterator[tuple[str, str, str]]:
    """(kind, name, file) of each table that names a file of code."""
    for kind in KINDS:
        for name, own in _table(table.get(kind)).items():
            file = _table(own).get("file")
            if isinstance(file, str) and (kind == "question" or file.endswith(".py")):
                yield kind, name, file


def _strange(tables: object, path: Path) -> list[str]:
    """What [question] may not say: it has files of kinds of questions alone."""
    if not isinstance(tables, Mapping):
        return [f"{path}: question = {shown(tables)}: expected tables, [question.NAME]"]
    return [
        f"{path}: question.{name} = {shown(own)}: expected a table with the `file` of a kind of "
        "question; questions stand in [questions]"
        for name, own in tables.items()
        if not isinstance(_table(own).get("file"), str)
    ]


def _read(path: Path, where: str, file: str) -> bytes:
    try:
        return read_beside(path, file, LARGEST_TEXT)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise InputError(f"{where}: expected a Python file beside the study ({reason})") from None


def _take(own: PluginFile, path: Path, where: str, tried: bool = False) -> None:
    trust.demand(where, own.file, own.sha256)
    if not tried:
        _demand_suite(own, path, where)
    provide(own, path, where)


def provide(own: PluginFile, path: Path, where: str) -> str:
    """Run the file and make its plug-in known by its name. Raises InputError."""
    constant = registry.KINDS[own.kind].constant
    module = ModuleType(f"seethrough_own_{own.sha256[:16]}")  # the same in every process
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # dataclasses look there
    try:
        exec(compile(own.content, str(path), "exec"), module.__dict__)
        if not hasattr(module, constant):
            raise InputError(f"{where}: expected a {constant} in it")
        plugin = getattr(module, constant)
        name = str(plugin.name)
        if own.name not in ("", name):
            raise InputError(f"{where}: calls itself {name!r}, expected {own.name!r}")
        origin = registry.Origin((path,), own.sha256, own.file, own.content)
        registry.provide(own.kind, name, plugin, origin)
        return name
    except InputError:
        raise
    except registry.PluginError as error:
        raise InputError(f"{where}: {error}") from None
    except Exception as error:  # its code may raise anything
        said = one_line(f"{type(error).__name__}: {error}")
        at = registry.place_in(error, {str(path)})
        raise InputError(f"{where}: cannot be loaded ({said}){at}") from None


def _demand_suite(own: PluginFile, path: Path, where: str) -> None:
    """Raises InputError unless the kind's suite finds nothing. It runs in a process of its own, so
    that whatever hangs there can be ended; what passed once is remembered."""
    from seethrough.experiment.session.software import program_sha256

    passed = f"{own.sha256}-{program_sha256()}"
    if passed in trust.lines_of(trust.kept_file("passed")):
        return
    print(f"{where}: tried by the suite, once", file=sys.stderr, flush=True)
    command = [sys.executable, "-m", "seethrough", own.kind, "check", str(path), "--trust"]
    try:
        run = subprocess.run(
            command, capture_output=True, text=True, timeout=SUITE_LIMIT, check=False,
            stdin=subprocess.DEVNULL,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise InputError(
            f"{where}: expected to be through with the suite within {SUITE_LIMIT:.0f} s; "
            f"`seethrough {_asked_for(own.kind, path)}` shows where it stands"
        ) from None
    if run.returncode:
        lines = [*run.stdout.splitlines(), *run.stderr.splitlines()]
        found = next((line for line in lines if not line.startswith("ok")), "it ended by itself")
        unread = found.removeprefix(f"seethrough: {_asked_for(own.kind, path)}: ")
        if unread != found:
            raise InputError(f"{where}: {one_line(unread)}")
        said = one_line(" ".join(found.removeprefix("FAIL").split()))
        raise InputError(
            f"{where}: expected what its suite demands: {said} "
            f"(all of it: `seethrough {_asked_for(own.kind, path)}`)"
        )
    trust.add_line(trust.kept_file("passed"), passed)


def _asked_for(kind: str, path: Path) -> str:
    """What a suite is run with, which begins what is said of a file that it cannot read."""
    return f"{kind} check {path}"


def from_path(kind: str, path: Path) -> str:
    """The name of a plug-in in a file, which is known from now on. Raises InputError."""
    where = _asked_for(kind, path)
    try:
        content = read_regular(path, LARGEST_TEXT)
    except OSError as error:
        raise InputError(f"{where}: cannot be read ({error.strerror})") from None
    own = PluginFile(kind, "", path.name, content)
    trust.demand(where, path.name, own.sha256)
    return provide(own, path.resolve(), where)


def files_of(described: Sequence[Mapping[str, str]]) -> list[PluginFile]:
    """The files among a study's plug-ins that it brought along."""
    found = []
    for said in described:
        origin = registry.origin(said["kind"], said["name"])
        if origin is not None and origin.beside:
            found.append(PluginFile(said["kind"], said["name"], origin.beside, origin.content))
    return found


def keep(described: list[dict[str, str]], data: Path) -> None:
    """Put the files that a study brought along into the data folder. Raises InputError."""
    for own in files_of(described):
        path = kept_as({"kind": own.kind, "name": own.name, "sha256": own.sha256}, data)
        try:
            make_folder(path.parent)
            if not path.exists():
                write_new(path, own.content)
        except FileExistsError:
            pass  # another station kept it first
        except OSError as error:
            raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def kept_as(said: Mapping[str, str], data: Path) -> Path:
    """Where a data folder keeps a plug-in that a sidecar describes."""
    return data / FOLDER / f"{said['kind']}-{said['name']}-{said['sha256'][:12]}.py"


def kept(study: Mapping[str, Any], data: Path) -> None:
    """Make the plug-ins known that a sidecar's study used, as its data folder kept them. Raises
    InputError."""
    for said in study.get("plugins", ()):
        if not said.get("file"):
            continue
        path = kept_as(said, data)
        where = f"{path}: {said['kind']} {said['name']}"
        try:
            content = read_regular(path, LARGEST_TEXT)
        except OSError as error:
            raise InputError(f"{where}: cannot be read ({error.strerror})") from None
        own = PluginFile(said["kind"], said["name"], said["file"], content)
        if own.sha256 != said["sha256"]:
            raise InputError(f"{where}: not as it was kept: expected {said['sha256'][:12]}")
        _take(own, path, where, tried=True)
