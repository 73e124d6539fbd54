"""What a session's sidecar says about how it came about."""

import hashlib
import json
import platform
from importlib import metadata

from seethrough.experiment.session.software import program_sha256, provenance
from seethrough.experiment.study.config import load

STUDY = load("published")


def test_the_sidecar_holds_the_whole_study_and_where_it_ran():
    display = {"renderer": "llvmpipe", "size": "800x600"}
    told = json.loads(json.dumps(provenance(STUDY, display, speed=1.0)))
    # The study as resolved can be read again, defaults included, and has the hash that is given.
    plain = json.dumps(told["study"], sort_keys=True)
    assert hashlib.sha256(plain.encode()).hexdigest() == told["study_sha256"] == STUDY.digest()
    assert told["study"]["practice"]["limit"] == STUDY.practice.limit
    assert told["seed"] == STUDY.general.seed
    assert told["display"] == display and told["speed"] == 1.0
    for name in ("seethrough", "moderngl", "pyglet", "numpy"):
        assert told["versions"][name] == metadata.version(name)
    assert told["python"] == platform.python_version() and platform.system() in told["system"]
    assert told["program_sha256"] == program_sha256() and len(program_sha256()) == 64


FILES = ("tasks/deep/a.py", "seethrough/registry.py", "renderer/shaders/a.frag",
         "renderer/models/shipped/a.glb", "experiment/pages/languages/a.toml")  # fmt: skip


def _program(root, changed=None, name=None):
    """The hash of a program of FILES, one of them `changed` or called something else."""
    for file in FILES:
        path = root / (name if file == changed and name else file)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("2" if file == changed and not name else "1")
    return program_sha256(root)


def test_any_change_of_the_program_is_another_hash(tmp_path):
    before = _program(tmp_path / "before")
    assert _program(tmp_path / "again") == before
    hashes = [_program(tmp_path / str(k), file) for k, file in enumerate(FILES)]
    assert len({before, *hashes}) == 1 + len(FILES)
    assert _program(tmp_path / "named", FILES[0], "tasks/deep/b.py") not in {before, *hashes}


def test_what_lies_about_is_not_the_program(tmp_path):
    before = _program(tmp_path / "before")
    for name in ("tasks/deep/__pycache__/a.toml", "tasks/deep/a.py~"):
        path = tmp_path / "about" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("x")
    assert _program(tmp_path / "about") == before
