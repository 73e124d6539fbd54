"""What a session's sidecar says about how it came about."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Iterator, Mapping
from functools import cache
from importlib import metadata
from pathlib import Path

from seethrough.analysis.load.files import table_in
from seethrough.experiment.study.config import Study

PACKAGES = ("seethrough", "moderngl", "pyglet", "numpy", "imgui-bundle", "pydantic")


OURS = ("experiment", "tasks", "renderer")  # what a session runs, beside the package's own modules
ROOT = Path(__file__).parents[2]
# Shaders, texts and models are part of the program; what an editor leaves behind is not.
SUFFIXES = {".py", ".frag", ".vert", ".glsl", ".toml", ".txt", ".glb", ".npz"}


@cache
def program_sha256(root: Path = ROOT) -> str:
    """SHA-256 of the program's files and their names: a version number stays while code changes."""
    digest = hashlib.sha256()
    for name, path in sorted(_files(root)):
        digest.update(name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def _files(root: Path) -> Iterator[tuple[str, Path]]:
    """Names and places. In a wheel the rooms lie within the package, in a checkout beside it."""
    package = root / "seethrough"
    for path in (package if package.is_dir() else root).glob("*.py"):
        yield f"seethrough/{path.name}", path
    for room in OURS:
        for path in (root / room).rglob("*"):
            if path.suffix in SUFFIXES and "__pycache__" not in path.parts:
                yield path.relative_to(root).as_posix(), path


def provenance(study: Study, display: Mapping[str, str], **more: object) -> dict[str, object]:
    """Config as resolved and its hash, versions, machine, display, seeds."""
    return {
        "study": study.resolved(),
        "study_sha256": study.digest(),
        "seed": study.general.seed,
        "program_sha256": program_sha256(),
        "versions": {name: metadata.version(name) for name in PACKAGES},
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "display": dict(display),
        **more,
    }


def changed_since(before: Mapping[str, object], now: Mapping[str, object]) -> list[str]:
    """What of the program is not as in an earlier session: `name: old, now new`."""
    parts = {"program": "program_sha256", "python": "python"}
    old = {name: str(before.get(key, "unknown"))[:12] for name, key in parts.items()}
    new = {name: str(now.get(key, "unknown"))[:12] for name, key in parts.items()}
    was, is_ = (table_in({"versions": {}, **made}, "versions") for made in (before, now))
    for name in sorted(was.keys() | is_.keys()):
        old[name], new[name] = (str(v.get(name, "not there")) for v in (was, is_))
    return [f"{name}: {old[name]}, now {new[name]}" for name in old if old[name] != new[name]]
