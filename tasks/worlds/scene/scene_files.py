"""The files of a study's scenes: found beside it, checked, kept with its data."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from seethrough.renderer.meant import meant, one_of
from seethrough.tasks.kit.tags import fits
from seethrough.tasks.kit.world import FileFault, FileFaults
from seethrough.tasks.worlds.scene.kept_scene import packed
from seethrough.tasks.worlds.scene.scene_parameters import READER, SceneParameters, is_shipped
from seethrough.tasks.worlds.scene.scene_place import (
    ScenePlace,
    kept_name,
    opened,
    path_of,
    read,
)

SHOWN = 8  # names that a message lists


def named(p: SceneParameters) -> dict[str, str]:
    """Key → file, of the scenes that are not ours."""
    return {f"files[{i}]": file for i, file in enumerate(p.files) if not is_shipped(file)}


def found(p: SceneParameters, folder: Path) -> SceneParameters:
    """The parameters with their files, which lie in the folder, read and hashed; all that they say
    of the files is checked. Raises FileFaults, all that is wrong."""
    pinned = p.sha256
    p = replace(p, folder=str(folder), sha256=(), reader=READER)
    hashes, faults = [], []
    for number, file in enumerate(p.files):
        try:
            hashes.append(read(p, file).digest)
        except (ValueError, OSError) as error:
            faults.append(_of_file(p, number, error))
    faults += [] if faults else _another(p, pinned, hashes)
    if faults:
        raise FileFaults(faults)
    p = replace(p, sha256=tuple(hashes))
    places = []
    for number, file in enumerate(p.files):
        try:
            places.append(opened(p, file))
        except ValueError as error:
            key, _, rest = str(error).partition(" = ")
            own = key == "about"
            said = rest.partition(": ")[2]
            faults.append(FileFault(key, p.about, f"expected a name in {file}: {said}") if own
                          else _of_file(p, number, error))  # fmt: skip
    faults += [] if faults else _checked(p, places)
    if faults:
        raise FileFaults(faults)
    return p


def _of_file(p: SceneParameters, number: int, error: Exception) -> FileFault:
    said = str(error).removeprefix(f"{path_of(p, p.files[number])}: ")
    if isinstance(error, OSError):
        said = error.strerror or str(error)
    return FileFault(f"files[{number}]", p.files[number], said)


def _another(p: SceneParameters, said: Sequence[str], hashes: Sequence[str]) -> Iterator[FileFault]:
    """Files that are not those that the study says, or one file, or a copy of it, by two names."""
    for number, (expected, own) in enumerate(zip(said, hashes, strict=False)):
        if expected != own:
            yield FileFault(f"sha256[{number}]", expected, f"expected {own}, which the file has")
    paths = [path_of(p, file).resolve() for file in p.files]
    for number, (path, digest) in enumerate(zip(paths, hashes, strict=True)):
        first = next(i for i in range(number + 1) if paths[i] == path or hashes[i] == digest)
        if first < number:
            said = f"expected a file that differs from {p.files[first]}"
            yield FileFault(f"files[{number}]", p.files[number], said)


def _checked(p: SceneParameters, places: Sequence[ScenePlace]) -> Iterator[FileFault]:
    """What is said of things and cameras that there are not."""
    names = list(dict.fromkeys(name for place in places for name in place.names))
    for number, tag in enumerate(p.tags):
        if not any(fits(name, tag.name) for name in names):
            yield FileFault(f"tags[{number}].name", tag.name, _expected("a thing", tag.name, names))
    for place in places:
        if p.start and p.start not in place.cameras:
            yield _no_camera("start", p.start, place)
    by_file = {place.file: place for place in places}
    for number, item in enumerate(p.items):
        if item in p.items[:number]:
            first = p.items.index(item)
            yield FileFault(
                f"items[{number}].ask", item.ask, f"expected another than items[{first}]"
            )
        own = by_file.get(item.file) if item.file or len(places) > 1 else places[0]
        if own is None:
            said = f"expected {one_of(item.file, p.files)}"
            yield FileFault(f"items[{number}].file", item.file, said)
            continue
        if item.ask not in own.names:
            said = _expected(f"a thing of {own.file}", item.ask, own.names)
            yield FileFault(f"items[{number}].ask", item.ask, said)
        elif not own.scene.targets[own.names.index(item.ask)]:
            said = "expected a target: tag it with target = true"
            yield FileFault(f"items[{number}].ask", item.ask, said)
        if item.start and item.start not in own.cameras:
            yield _no_camera(f"items[{number}].start", item.start, own)


def _no_camera(key: str, value: str, place: ScenePlace) -> FileFault:
    return FileFault(key, value, _expected(f"a camera of {place.file}", value, list(place.cameras)))


def _expected(what: str, name: str, known: Sequence[str]) -> str:
    more = f" … and {len(known) - SHOWN} more" if len(known) > SHOWN else ""
    there = ", ".join(known[:SHOWN]) or "none"
    return f"expected {what}{meant(name, known) or ';'} there are: {there}{more}"


def keeps(p: SceneParameters) -> dict[str, Callable[[], bytes]]:
    """Name → content, of the files that a data folder keeps."""
    return {kept_name(p, file): partial(_packed, p, file) for file in p.files}


def _packed(p: SceneParameters, file: str) -> bytes:
    return packed(read(p, file))


def kept_in(p: SceneParameters, folder: Path) -> SceneParameters:
    """The parameters of a sidecar, with the scenes as a data folder has them. Raises FileFaults."""
    p = replace(p, folder=str(folder))
    faults = []
    for number, file in enumerate(p.files):
        path = folder / kept_name(p, file) if p.sha256 else folder
        if not path.is_file():
            said = f"expected the scene as it was shown, in {path}"
            faults.append(FileFault(f"files[{number}]", file, said))
            continue
        try:
            read(p, file)
        except (ValueError, OSError) as error:
            faults.append(FileFault(f"files[{number}]", file, f"expected what was kept: {error}"))
    if faults:
        raise FileFaults(faults)
    return p
