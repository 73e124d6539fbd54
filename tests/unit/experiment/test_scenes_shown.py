"""`power --scenes`: what each condition shows of a scene, and scenes that a study selects."""

import csv
import json
import re
import tomllib

import numpy as np
import pytest
from numpy.testing import assert_allclose

from seethrough.analysis.load.sidecar_design import read_design
from seethrough.experiment import cli
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.checked.shown import Shower, Shown, apart, measured
from seethrough.experiment.study.config import load, parse
from seethrough.experiment.study.selection import said
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.study.shown.prereg import preregistration
from seethrough.renderer.gpu.device.context import standalone
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.visibility import Visibility
from seethrough.renderer.techniques.standard.opaque import Standard

STUDY = """
[study]
name = "small"
title = "x"
description = "x"
participants = 1
seed = 5
[design]
tasks = ["count"]
trials = 1
[factors.transparency]
levels.standard = { technique.use = "standard" }
levels.dynamic = { technique.use = "dynamic" }
[factors.clutter]
set = "world.abstract.objects"
values = [20, 40]
[world.abstract]
side = 50.0
target_share = [0.3, 0.4]
[world]
use = "abstract"
"""
RULE = '[design.select]\nfactor = "transparency"\nleast = {}\n'


def study_file(folder, more="", text=STUDY):
    path = folder / "small.toml"
    path.write_text(text + more)
    return str(path)


def at(x, y, z):
    matrix = np.eye(4)
    matrix[:3, 3] = (x, y, z)
    return matrix


def test_a_target_behind_half_a_wall_shows_half():
    """By geometry: the wall's edge halves one cube, the other stands free; with nothing before
    them each has all of its pixels."""
    cube, wall = geometry.box(2.0, 2.0, 2.0), geometry.box(10.0, 10.0, 0.1)
    scene = Scene(
        (
            Object(cube, at(0, 0, 0), (1, 0, 0)),  # asked for, and no target of the technique
            Object(wall, at(5.0, 0, 3.0), (0, 0, 1)),
            Object(cube, at(-6, 0, 0), (1, 0, 0), target=True),
        )
    )
    shower = Shower(parse(tomllib.loads(STUDY), "x"), standalone())
    camera = look_at(np.array([0.0, 0.0, 30.0]), np.zeros(3))
    for asked, expected in (([0], 0.5), ([2], 1.0), ([0, 2], 0.75)):
        index = np.array(asked)
        whole = shower._whole(scene, [camera], index)
        seen = shower._seen(scene, camera, Standard(), index)
        shown, _, hidden = measured([seen], whole, index, shower._pixels)
        # The id picture has 150 rows: a cube is some 9 pixels wide, its edge is known to ± 1/2.
        assert shown == pytest.approx(expected, abs=0.06) and hidden == 0


def visibility(area, contrast):
    n = len(area)
    return Visibility(np.ones(n, dtype=int), np.ones(n), np.zeros((n, 2)), np.array(contrast),
                      np.array(area) / 100)  # fmt: skip


def test_shares_by_hand():
    """Thing 0: 5 of 10 and 10 of 10 pixels, the second set off by a tenth (.2 is clear): shown
    .75, clear (.5 + .5) / 2. Thing 1 is in the first view alone, and hidden. Thing 2 is in none:
    it counts for no share, but nobody sees it."""
    seen = [visibility([5, 0, 0], [0.4, 0.4, 0.0]), visibility([10, 3, 0], [0.1, 0.4, 0.0])]
    whole = np.array([[10.0, 8.0, 0.0], [10.0, 0.0, 0.0]])
    shown, clear, hidden = measured(seen, whole, np.arange(3), 100)
    assert_allclose([shown, clear], [(0.75 + 0) / 2, (0.5 + 0) / 2], rtol=1e-12)
    assert hidden == 2


def differences(rows):
    """Scene → how much more the second technique shows of it than the first."""
    by = {}
    for row in rows:
        by.setdefault(row["scene"], {})[row["transparency"]] = float(row["shown"])
    return {scene: own["dynamic"] - own["standard"] for scene, own in by.items()}


def one(levels, shown):
    return Shown(None, levels, 3, shown, shown, 0)


def test_levels_are_apart_by_their_means_over_the_other_factors():
    shown = {("x", "1"): 0.2, ("x", "2"): 0.4, ("y", "1"): 0.5, ("y", "2"): 0.9}
    found = [one({"a": a, "b": b}, share) for (a, b), share in shown.items()]
    assert_allclose([apart(found, "a"), apart(found, "b")], [0.4, 0.3])


def test_each_scene_is_shown_in_every_condition_that_leaves_it_as_it_is(tmp_path, capsys):
    out = tmp_path / "shown.csv"
    assert cli.main(["power", study_file(tmp_path), "--scenes", str(out)]) == 0
    with open(out, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    # One person meets 2 × 2 cells, a scene of their own in each: every scene in both techniques,
    # and in the clutter that it was made with.
    scenes = {row["scene"] for row in rows}
    assert len(scenes) == 4 and len(rows) == 8
    for scene in scenes:
        own = [row for row in rows if row["scene"] == scene]
        assert {row["transparency"] for row in own} == {"standard", "dynamic"}
        assert len({row["clutter"] for row in own}) == len({row["asked"] for row in own}) == 1
        assert all(0 < float(row["shown"]) <= 1 for row in own)
    more = list(differences(rows).values())
    assert len(set(more)) == 4  # the technique does something, and not the same
    said = capsys.readouterr().out
    assert "count: 4 scenes" in said and "clutter:" not in said
    assert f"transparency: dynamic − standard {np.mean(more):+.2f}" in said
    assert f"shows more in {sum(m > 0 for m in more)} of 4 scenes" in said
    assert not re.search(r"better|best|worse|worst|selected", said)


def test_a_declared_rule_is_held_to_and_what_breaks_it_drawn_again(tmp_path, capsys):
    """At the difference of the scene that has the third largest, two of four have to go; with the
    printed line all four keep the rule."""
    out = tmp_path / "shown.csv"
    assert cli.main(["power", study_file(tmp_path), "--scenes", str(out)]) == 0
    with open(out, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    more = sorted(map(abs, differences(rows).values()))
    least = more[2] - 0.001
    wrong = sum(m < least for m in more)
    capsys.readouterr()
    path = study_file(tmp_path, RULE.format(round(least, 3)))
    assert cli.main(["power", path, "--scenes", str(tmp_path / "again.csv")]) == 1
    told = capsys.readouterr().out
    assert "scenes selected: only scenes in which the levels of transparency are at least" in told
    assert f"{wrong} of 4 scenes do not keep the rule" in told
    (line,) = re.findall(r"in \[design\]: (redraw = \[.*\])", told)
    text = STUDY.replace("trials = 1\n", f"trials = 1\n{line}\n")
    path = study_file(tmp_path, RULE.format(round(least, 3)), text)
    assert cli.main(["power", path, "--scenes", str(tmp_path / "kept.csv")]) == 0
    assert "do not keep" not in capsys.readouterr().out
    assert f"{len(set(load(path).design.redraw))} scene" in said(load(path))


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("[design.select]\n", r"design.select: expected `factor` and `least`, or a `rule`"),
        (RULE.format(0.1).replace("transparency", "clutter"),
         r'design.select.factor = "clutter": expected a factor that leaves scenes alone: '),
        ('[design.select]\nfactor = "transparency"\n', r"design.select.least: expected with"),
        ("[design.select]\nleast = 0.1\n", r"design.select.factor: expected with"),
        (RULE.format(1.5), r"design.select.least = 1.5: expected a number"),
        ('[design.select]\nfacter = "x"\n', r"design.select.facter = \"x\": unknown key, did you "
         "mean factor"),
    ],
)  # fmt: skip
def test_a_rule_that_selects_nothing_is_refused_in_a_line(tmp_path, more, message):
    with pytest.raises(InputError, match=message):
        load(study_file(tmp_path, more))


def test_records_and_preregistration_say_the_rule_and_nothing_where_there_is_none(tmp_path):
    plain = load(study_file(tmp_path))
    assert "selected" not in design_entry(plain) and "select" not in plain.resolved()["design"]
    assert "selected" not in preregistration(plain)
    rule = '[design.select]\nrule = "every second file of {the} corpus."\n'
    study = load(study_file(tmp_path, rule))
    entry = json.loads(json.dumps(design_entry(study)))
    assert entry["selected"] == "every second file of {the} corpus"
    assert read_design(entry, "x").selected == entry["selected"]
    assert "by a rule that is declared here: every second file" in preregistration(study)
    assert study.digest() != plain.digest()
    again = parse(json.loads(json.dumps(study.resolved())), "x")
    assert again.design.select == study.design.select and again.digest() == study.digest()
