"""A study's own models: found beside its file, kept in its data folder, found there again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.study.model_files import check_files
from seethrough.tasks.kit.own_models import READER, kept_as, mesh_of, packed, read
from seethrough.tasks.parameters import BuildingParameters

FOLDER = "models"


def beside(parameters: BuildingParameters, path: Path) -> BuildingParameters:
    """The [walkthrough] of the study file at `path`, its models read, with their files' hashes.
    Raises InputError."""
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
                f"{path}: walkthrough.models[{number}].file = {model.file!r}: {reason}"
            ) from None
    return replace(parameters, models=tuple(found))


def keep(parameters: BuildingParameters, data: Path) -> None:
    """Put the meshes into the data folder, for replays on any machine. Raises InputError."""
    for model in parameters.models:
        path = kept_as(replace(model, folder=str(data / FOLDER)))
        try:
            make_folder(path.parent)
            if not path.exists():
                write_new(path, packed(mesh_of(model)))
        except FileExistsError:
            pass  # another station kept it first, under the name of the same file
        except OSError as error:
            raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def kept(parameters: BuildingParameters, data: Path) -> BuildingParameters:
    """The [walkthrough] of a sidecar, its models as the data folder kept them.
    Raises InputError."""
    found = [replace(model, folder=str(data / FOLDER)) for model in parameters.models]
    for model in found:
        if not kept_as(model).is_file():
            raise InputError(f"{kept_as(model)}: expected the model {model.name!r} as it was shown")
    return replace(parameters, models=tuple(found))
