"""What tells the simulated participants' own code from any other: rows depend on it."""

from __future__ import annotations

import hashlib
from functools import cache
from importlib import resources
from pathlib import Path


@cache
def code_sha256() -> str:
    """The first 12 hexadecimal digits of a SHA-256 of the files in this folder but for those that
    compare people with published ones, of the skills and of what our tasks do with them."""
    digest = hashlib.sha256()
    people, tasks = Path(__file__).parent, Path(str(resources.files("seethrough.tasks")))
    playing = (path for path in people.rglob("*.py") if path.parent.name != "fitted")
    own = (*playing, *tasks.glob("kit/skills/*.py"), *tasks.glob("*/simulate.py"))
    for path in sorted(own):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]
