"""Psych-DS: the file that says what a data folder holds."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.experiment.files.json_files import read_object
from seethrough.experiment.files.private import make_folder, write_new
from seethrough.experiment.record.columns import Column

FILE = "dataset_description.json"


def describe_dataset(data: Path, study: str, tables: Mapping[str, tuple[Column, ...]]) -> None:
    """Make the folder and its description, or check that it is this study's. Raises InputError."""
    path = data / FILE
    columns = {c.name: c for table in tables.values() for c in table}
    content = description(
        study, f"Trials and questionnaires of the study {study}, recorded by Seethrough.", columns
    )
    try:
        make_folder(data)
        if not path.exists():
            write_new(path, json.dumps(content, indent=2, ensure_ascii=False) + "\n")
    except FileExistsError:
        pass  # another station described it first: checked below
    except OSError as error:
        raise InputError(f"{data}: cannot be written: {error.strerror}") from None
    check_name(path, study)


def description(study: str, text: str, columns: Mapping[str, Column]) -> dict[str, object]:
    """Global metadata of a dataset with these columns."""
    return {
        "@context": "https://schema.org",
        "@type": "Dataset",
        "name": study,
        "description": text,
        "variableMeasured": [
            {
                "@type": "PropertyValue",
                "name": name,
                "description": c.description,
                **({"unitText": c.unit} if c.unit else {}),
            }
            for name, c in columns.items()
        ],
    }


def check_name(path: Path, study: str) -> None:
    """Raises InputError where a description is that of another study."""
    name = read_object(path).get("name")
    if name != study:
        raise InputError(f"{path}: name = {name!r}: expected {study!r}; choose another folder")
