"""Profiles as files: constants with the provenance of where they come from."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from dataclasses import asdict, fields, replace
from pathlib import Path

from seethrough.analysis.files.written import write_over
from seethrough.experiment.errors import InputError, gathered, short, shown, unknown
from seethrough.experiment.study.beside.toml_file import read_toml
from seethrough.renderer.meant import meant
from seethrough.tasks.kit.skills.profile import AVERAGE, PROFILES, Profile

SHIPPED = Path(__file__).with_name("profiles")  # files that come with the program


def names() -> tuple[str, ...]:
    """Profiles that need no file of one's own."""
    return (*PROFILES, *sorted(p.stem for p in SHIPPED.glob("*.toml")))


def find(name: str) -> Profile:
    """A profile by its name, or from a TOML file. Raises InputError."""
    if name in PROFILES:
        return PROFILES[name]
    path = SHIPPED / f"{name}.toml" if name in names() else Path(name)
    if not os.path.lexists(path):
        raise InputError(
            f"--profile = {name}: expected one of {', '.join(names())}, or a profile file"
            + meant(name, names())
        )
    return read(path)


def read(path: Path) -> Profile:
    """The profile in a file: [profile] holds what differs from the average one."""
    content = read_toml(path)
    values = content.get("profile", {})
    if not isinstance(values, dict):
        raise InputError(f"{path}: profile = {values}: expected a table")
    if faults := [f"{path}: profile.{fault}" for fault in _faults(values)]:
        raise gathered(faults)
    try:
        return replace(AVERAGE, **{"name": path.stem, **values})
    except ValueError as error:
        raise InputError(f"{path}: profile.{error}") from None


def provenance_of(path: Path) -> dict[str, object]:
    """Where a profile file comes from; nothing where it does not say."""
    found = read_toml(path).get("provenance", {})
    return dict(found) if isinstance(found, dict) else {}


def made_by(name: str, part: str = "") -> tuple[str, tuple[str, ...]]:
    """The command that fitted a profile file, and its table; nothing for those of the program.

    `part`: what was added to the fit, "search" or "intervals".
    """
    path = SHIPPED / f"{name}.toml" if name in names() else Path(name)
    found: object = provenance_of(path) if path.is_file() else {}
    if part and isinstance(found, dict):
        found = found.get(part, {})
    if not isinstance(found, dict):
        return "", ()
    return str(found.get("command", "")), tuple(map(str, found.get("table", ())))


def add(path: Path, part: str, said: Mapping[str, object]) -> None:
    """Add to a profile file's provenance what else was found out about the fit."""
    write(path, read(path), {**provenance_of(path), part: dict(said)})


def _faults(values: Mapping[str, object]) -> Iterator[str]:
    """What is wrong with the keys of a profile, a line each."""
    known = sorted(f.name for f in fields(Profile))
    for key, value in values.items():
        wanted = str if key == "name" else (int, float)
        if key not in known:
            yield f"{short(key)} = {shown(value)}: {unknown(key, known)}"
        elif isinstance(value, bool) or not isinstance(value, wanted):
            yield f"{key} = {shown(value)}: expected a {_word(wanted)}"


def write(path: Path, profile: Profile, provenance: Mapping[str, object]) -> None:
    """Write what differs from the average profile, and where it comes from."""
    average = asdict(AVERAGE)
    lines = ["# A profile of simulated participants: a tool for planning studies, never evidence."]
    lines += ["", "[profile]"]
    lines += [f"{k} = {_toml(v)}" for k, v in asdict(profile).items() if v != average[k]]
    inner = {k: v for k, v in provenance.items() if isinstance(v, Mapping)}
    lines += ["", "[provenance]"]
    lines += [f"{k} = {_toml(v)}" for k, v in provenance.items() if k not in inner]
    for part, said in inner.items():
        lines += ["", f"[provenance.{part}]"]
        lines += [f"{k} = {_toml(v)}" for k, v in said.items()]
    write_over(path, "\n".join(lines) + "\n")


def _word(kind: object) -> str:
    return "text" if kind is str else "number"


def _toml(value: object) -> str:
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(value, list | tuple):
        line = "[" + ", ".join(_toml(v) for v in value) + "]"
        return (
            line if len(line) < 80 else "[\n" + "".join(f"    {_toml(v)},\n" for v in value) + "]"
        )
    return repr(value)
