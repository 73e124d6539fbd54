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
    assert told["seed"] == STUDY.study.seed
    assert told["display"] == display and told["speed"] == 1.0
    for name in ("seethrough", "moderngl", "pyglet", "numpy"):
        assert told["versions"][name] == metadata.version(name)
    assert told["python"] == platform.python_version() and platform.system() in told["system"]
    assert told["program_sha256"] == program_sha256() and len(program_sha256()) == 64


def test_any_change_of_the_program_is_another_hash(tmp_path):
    hashes = []
    for number, (name, code) in enumerate((("a", "1"), ("a", "2"), ("b", "1"), ("a", "1"))):
        root = tmp_path / str(number)
        (root / "tasks" / "deep").mkdir(parents=True)
        (root / "tasks" / "deep" / f"{name}.py").write_text(code)
        hashes.append(program_sha256(root))
    assert hashes[0] == hashes[3] and len({*hashes}) == 3
