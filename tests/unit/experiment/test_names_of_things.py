"""Names that a study gives its things: letters that the font lacks are refused where participants
would see a box, and sheets of pictures are written in the pages' own font."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from PIL import Image, ImageDraw
from scene_files import CORNERS, FACES, file_of
from small_study import SMALL

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.checked import sheet_text
from seethrough.experiment.study.config import load


def study_of(folder, task, world):
    head, _, rest = SMALL.partition("[world.abstract]")
    text = head.replace('["pattern"]', f'["{task}"]') + world + rest[rest.index("[practice]") :]
    (folder / "small.toml").write_text(text, encoding="utf-8")
    return str(folder / "small.toml")


def test_what_is_asked_for_has_letters_that_can_be_shown(tmp_path):
    """Of a scene those of targets, by label where they have one; of a building its models."""
    nodes = [
        {"name": f"{name}", "mesh": 0, "translation": [5 * i, 0, 0], "extras": extras}
        for i, (name, extras) in enumerate(
            (
                ("pompe à huile", {"target": True}),
                ("泵", {"target": True, "label": "pump"}),
                ("管", {}),
                ("valve 🎉", {"target": True}),
            )
        )
    ]
    (tmp_path / "a.glb").write_bytes(file_of(nodes, range(4)))
    path = study_of(tmp_path, "locate", '[world]\nuse = "scene"\nscene.files = ["a.glb"]\n')
    with pytest.raises(InputError) as caught:
        load(path)
    said = 'a thing is called "valve 🎉": expected letters that the font has, not 🎉'
    assert list(caught.value.lines) == [f"{path}: world.scene.files[0]: {said}"]
    (tmp_path / "a.glb").write_bytes(file_of(nodes[:3], range(3)))
    load(path)

    record = struct.Struct("<12fH")
    rows = b"".join(record.pack(0, 0, 0, *CORNERS[f].ravel(), 0) for f in FACES)
    (tmp_path / "a.stl").write_bytes(b"\0" * 80 + struct.pack("<I", len(FACES)) + rows)
    world = '[world]\nuse = "building"\nbuilding.models = [{ name = "泵", file = "a.stl" }]\n'
    path = study_of(tmp_path, "count_in_building", world)
    with pytest.raises(InputError) as caught:
        load(path)
    said = 'a thing is called "泵": expected letters that the font has, not 泵'
    assert list(caught.value.lines) == [f"{path}: world.building.models[0].name: {said}"]


def test_sheets_show_letters_and_keep_to_their_width():
    """Two letters that a font lacks look the same: its box. These do not."""

    def ink(text):
        picture = Image.new("L", (40, 30))
        ImageDraw.Draw(picture).text((2, 2), text, fill=255, font=sheet_text.font(17))
        return np.asarray(picture)

    letters = "èßøŁžЖΩ×"
    pictures = {ink(c).tobytes() for c in letters}
    assert len(pictures) == len(letters)
    font = sheet_text.font(13)
    assert sheet_text.fitted("ma scène", font, 500) == "ma scène"
    assert sheet_text.fitted("泵 2", font, 500) == "? 2"
    cut = sheet_text.fitted("x" * 200, font, 100)
    assert cut.endswith("…") and 80 < font.getlength(cut) <= 100
