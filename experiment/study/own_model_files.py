"""A study's own models: found beside its file, kept in its data folder, found there again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.study.model_files import check_files
from seethrough.experiment.study.plugin_files import keep as keep_plugins
from seethrough.tasks.kit.own_models import READER, OwnModel, kept_as, mesh_of, packed, read

if TYPE_CHECKING:
    from seethrough.experiment.study.study import Study

FOLDER = "models"


def own_models(place: Any) -> tuple[OwnModel, ...]:
    """The models that a world's parameters bring along."""
    return tuple(getattr(place, "models", ()))


def models_of(study: Study) -> tuple[OwnModel, ...]:
    """Every model that the study brings along, each once."""
    return tuple(dict.fromkeys(m for place in study.places() for m in own_models(place)))


def beside(parameters: Any, path: Path) -> Any:
    """A world's parameters of the study file at `path`, its models read, with their files' hashes.
    Raises InputError."""
    if not own_models(parameters):
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
    for model in models_of(study):
        path = kept_as(replace(model, folder=str(data / FOLDER)))
        try:
            make_folder(path.parent)
            if not path.exists():
                write_new(path, packed(mesh_of(model)))
        except FileExistsError:
            pass  # another station kept it first, under the name of the same file
        except OSError as error:
            raise InputError(f"{path}: cannot be written: {error.strerror}") from None


def kept(parameters: Any, data: Path) -> Any:
    """A world's parameters of a sidecar, its models as the data folder kept them.
    Raises InputError."""
    if not own_models(parameters):
        return parameters
    found = [replace(model, folder=str(data / FOLDER)) for model in parameters.models]
    for model in found:
        if not kept_as(model).is_file():
            raise InputError(f"{kept_as(model)}: expected the model {model.name!r} as it was shown")
    return replace(parameters, models=tuple(found))
