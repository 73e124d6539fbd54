"""Studies in whose worlds a task cannot be set: one line, status 2, whoever makes the scene."""

from __future__ import annotations

import pytest
from scene_files import file_of
from small_study import SMALL

from seethrough.experiment.cli import main

FLAT = [{"name": f"a{i}", "mesh": 0, "translation": [5 * i, 0, 0]} for i in range(4)]
WORLDS = {
    "depth_order": (
        '"scene"\nscene.files = ["a.glb"]\nscene.tags = [{ name = "*", target = true }]\n'
        "[task.depth_order]\nratio = 5.0",
        "task.depth_order.ratio = 5: expected two targets in one view of the world scene, ",
    ),
    "select": (
        '"abstract"\nabstract.objects = 3\nabstract.target_share = [0.0, 0.0]',
        "world.abstract: expected a target in each of its scenes, one has none",
    ),
    "unique": (
        '"building"\nbuilding.objects = 900\nbuilding.scenes = "own"',
        "world.building.objects = 900, object_radius = [1.0, 2.2]: expected room for them on a fl",
    ),
}


@pytest.mark.parametrize("task", WORLDS)
def test_no_scene_is_one_line_for_every_command(task, tmp_path, capsys, monkeypatch):
    """`check` and `render` beforehand, people that are drawn, and those of data mode."""
    monkeypatch.chdir(tmp_path)  # where `check` puts its sheet
    world, message = WORLDS[task]
    head, _, rest = SMALL.partition("[world.abstract]")
    rest = rest[rest.index("[practice]") :]
    study = tmp_path / "small.toml"
    text = head.replace('["pattern"]', f'["{task}"]') + f"[world]\nuse = {world}\n" + rest
    study.write_text(text, encoding="utf-8")
    (tmp_path / "a.glb").write_bytes(file_of(FLAT, range(4)))
    simulate = ["simulate", str(study), "--participants", "1"]
    for words in (
        ["check", str(study)],
        ["render", str(study), "--out", str(tmp_path / "a.png")],
        [*simulate, "--out", str(tmp_path / "seen")],
        [*simulate, "--mode", "data", "--out", str(tmp_path / "data")],
    ):
        assert main(words) == 2
        lines = [s for s in capsys.readouterr().err.splitlines() if s.startswith("seethrough")]
        assert len(lines) == 1
        assert lines[0].startswith(f"seethrough: {study}: {message}")
