"""A study's data in another form: read checked from the data folder, written into a new one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from seethrough.experiment.export.dataset import Dataset


def formats() -> dict[str, Callable[[Dataset, Path], None]]:
    """What `--format` may be, each with what writes it."""
    from seethrough.experiment.export.bids import bids
    from seethrough.experiment.export.parquet import parquet
    from seethrough.experiment.export.psychds import psychds
    from seethrough.experiment.export.wide import wide

    return {"wide": wide, "parquet": parquet, "bids": bids, "psychds": psychds}
