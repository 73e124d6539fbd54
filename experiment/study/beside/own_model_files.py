"""A study's own models and scenes: found beside its file, kept in its data folder, found there
again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import InputError, gathered, one_line, shown
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.study.beside.model_files import check_files
from seethrough.experiment.study.beside.plugin_files import keep as keep_plugins
from seethrough.tasks.catalog import WORLDS
from seethrough.tasks.kit.own_models import READER, OwnModel, kept_as, mesh_of, packed, read
from seethrough.tasks.kit.world import FileFaults, FileWorld, World, WorldParameters
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

if TYPE_CHECKING:
    from seethrough.experiment.study.study import Study

FOLDER = "models"


def own_models(place: WorldParameters) -> tuple[OwnModel, ...]:
    """The models that a world's parameters bring along."""
    return place.models if isinstance(place, BuildingParameters) else ()


def models_of(study: Study) -> tuple[OwnModel, ...]:
    """Every model that the study brings along, each once."""
    return tuple(dict.fromkeys(m for place in study.places() for m in own_models(place)))


def world_of(place: object) -> World:
    """The world that parameters are of."""
    return next(world for world in WORLDS.values() if isinstance(place, world.Parameters))


def own_scenes(study: Study) -> tuple[str, ...]:
    """The files beside the study that its worlds are made of."""
    worlds = {place: world_of(place) for place in study.places()}
    return tuple(
        file
        for place, world in worlds.items()
        if isinstance(world, FileWorld)
        for file in world.named(place).values()
    )


def _scenes_beside(
    world: FileWorld, name: str, parameters: WorldParameters, path: Path
) -> WorldParameters:
    """The parameters with their scenes read. Raises InputError."""
    where = f"{path}: world.{name}"
    faults = []
    for key, file in world.named(parameters).items():
        try:
            check_files(path, file)
        except (ValueError, OSError) as error:
            reason = error.strerror if isinstance(error, OSError) else error
            faults.append(f"{where}.{key} = {shown(file)}: expected a file: {reason}")
    if faults:
        raise InputError(*faults)
    try:
        return world.found(parameters, path.parent)
    except FileFaults as error:
        lines = [f"{where}.{f.key} = {shown(f.value)}: {one_line(f.said)}" for f in error.found]
        raise gathered(lines) from None


def beside(parameters: WorldParameters, path: Path) -> WorldParameters:
    """A world's parameters of the study file at `path`, its models and scenes read, with their
    files' hashes. Raises InputError."""
    world = world_of(parameters)
    if isinstance(world, FileWorld):
        return _scenes_beside(world, world.name, parameters, path)
    if not isinstance(parameters, BuildingParameters) or not parameters.models:
        return parameters
    found = []
    for number, model in enumerate(parameters.models):
        try:
            model = replace(model, folder=str(path.parent), reader=READER)
            check_files(path, model.file)
            _, facts = read(model)
            found.append(replace(model, sha256=facts.digest))
        except (ValueError, OSError) as error:
            reason = str(error).removeprefix(f"{path.parent / model.file}: ")
            raise InputError(
                f"{path}: world.building.models[{number}].file = {model.file!r}: {reason}"
            ) from None
    return replace(parameters, models=tuple(found))


def keep(study: Study, data: Path) -> None:
    """Put the meshes, and the code that the study brings along, into the data folder, for replays
    on any machine. Raises InputError."""
    keep_plugins(study.plugins(), data)
    for path, content in _kept_files(study, data / FOLDER):
        try:
            make_folder(path.parent)
            if not path.exists():
                write_new(path, content())
        except FileExistsError:
            pass  # another station kept it first, under the name of the same file
        except OSError as error:
            raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def _packed(model: OwnModel) -> bytes:
    return packed(mesh_of(model))


def _kept_files(study: Study, folder: Path) -> Iterator[tuple[Path, Callable[[], bytes]]]:
    for model in models_of(study):
        yield kept_as(replace(model, folder=str(folder))), partial(_packed, model)
    for place in study.places():
        world = world_of(place)
        if isinstance(world, FileWorld):
            for name, content in world.keeps(place).items():
                yield folder / name, content


def kept(parameters: WorldParameters, data: Path) -> WorldParameters:
    """A world's parameters of a sidecar, its models as the data folder kept them.
    Raises InputError."""
    world = world_of(parameters)
    if isinstance(world, FileWorld):
        try:
            return world.kept_in(parameters, data / FOLDER)
        except FileFaults as error:
            raise InputError(*(f"{data}: {f.value}: {f.said}" for f in error.found)) from None
    if not isinstance(parameters, BuildingParameters) or not parameters.models:
        return parameters
    found = [replace(model, folder=str(data / FOLDER)) for model in parameters.models]
    for model in found:
        if not kept_as(model).is_file():
            raise InputError(f"{kept_as(model)}: expected the model {model.name!r} as it was shown")
        try:
            mesh_of(model)
        except ValueError as error:
            raise InputError(str(error)) from None
    return replace(parameters, models=tuple(found))
