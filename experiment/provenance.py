"""What a session's sidecar says about how it came about."""

from __future__ import annotations

import platform
from collections.abc import Mapping
from importlib import metadata
from typing import Any

from experiment.config import Study

PACKAGES = ("seethrough", "moderngl", "pyglet", "numpy", "imgui-bundle", "pydantic")


def provenance(study: Study, display: Mapping[str, str], **more: Any) -> dict[str, Any]:
    """Config as resolved and its hash, versions, machine, display, seeds."""
    return {
        "study": study.resolved(),
        "study_sha256": study.digest(),
        "seed": study.study.seed,
        "versions": {name: metadata.version(name) for name in PACKAGES},
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()} {platform.machine()}",
        "display": dict(display),
        **more,
    }
