"""A copy of the data whose file names keep Psych-DS to the letter (decisions/0005)."""

from __future__ import annotations

from pathlib import Path

from seethrough.experiment.export.dataset import Dataset, check_labels, put
from seethrough.experiment.record.dataset import FILE


def psychds(data: Dataset, out: Path) -> None:
    """The data files under names that are strictly key-value pairs. Raises InputError."""
    check_labels("psychds", data.participants)
    put(out / FILE, (data.folder / FILE).read_text(encoding="utf-8"))
    for table, paths in data.files.items():
        for path in paths:
            for old in (path, path.with_suffix(".json")):
                if old.exists():
                    name = old.name.replace(f"_{table}_data.", f"_table-{table}_data.")
                    put(out / old.relative_to(data.folder).with_name(name),
                        old.read_bytes().decode("utf-8"))  # fmt: skip
