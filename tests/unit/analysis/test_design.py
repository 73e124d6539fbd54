"""The design as the sidecars say it: read, refused, and asked."""

from __future__ import annotations

import json

import pytest
from made_designs import DESIGNS, RIGHT, TIME, VIEWS, Design, factor, make_design

from seethrough.analysis.before import design_before
from seethrough.analysis.errors import DataError
from seethrough.analysis.load.sidecar_design import read_design
from seethrough.analysis.load.study import load_study
from seethrough.analysis.page.blocks import Table, walk
from seethrough.analysis.page.markdown import as_markdown
from seethrough.analysis.report import Options, make_report
from seethrough.analysis.sections.tests.omnibus import complete


def read(**entry):
    return read_design({**DESIGNS["four"].entry(), **entry}, "x.json")


def test_it_is_read_as_written():
    design = read_design(DESIGNS["six_by_three"].entry(), "x.json")
    assert design.levels == {
        "view": ("plain", "xray", "dynamic", "cut", "cut45", "lens"),
        "clutter": ("80", "180", "380"),
    }
    assert [c.key for c in design.factor("clutter").contrasts()] == ["clutter=180", "clutter=380"]
    assert design.factor("clutter").numbers == (80.0, 180.0, 380.0)
    assert design.main is design.factor("view")  # clutter changes the scenes
    assert design.left_out({"view": "plain", "clutter": "380"})
    assert sum(1 for _ in design.cells(design.crossed)) == 17
    assert [m.name for m in design.measures()] == ["time", "off", "correct"]


def test_a_baseline_need_not_be_the_first_level():
    design = read(factors=[{**VIEWS, "baseline": "cut"}])
    assert [c.level for c in design.contrasts()] == ["plain", "xray", "lens"]
    assert {c.baseline for c in design.contrasts()} == {"cut"}


def of_factor(**changes):
    return {"factors": [{**VIEWS, **changes}]}


def of_measure(**changes):
    return {"tasks": [{"name": "find", "code": "T1", "measures": [{**TIME, **changes}]}]}


@pytest.mark.parametrize(
    ("entry", "line"),
    [
        ({"factors": 3}, "x.json: design.factors = 3: expected an array of tables"),
        (of_factor(kind="beside"),
         "design.factors[0].kind = 'beside': expected one of within, between, measured"),
        (of_factor(levels=["a", "a"]),
         "design.factors[0].levels = ['a', 'a']: expected levels, each once"),
        (of_factor(baseline="none"),
         "design.factors[0].baseline = 'none': expected one of plain, xray, cut, lens"),
        (of_factor(numbers=[1, 2]),
         "design.factors[0].numbers = [1, 2]: expected a number for each level"),
        (of_factor(tasks={"plain": 5}),
         "design.factors[0].tasks.plain = 5: expected an array of texts"),
        (of_factor(tasks={"plain": ["find", 5]}),
         "design.factors[0].tasks.plain = ['find', 5]: expected an array of texts"),
        (of_factor(tasks=["find"]),
         "design.factors[0].tasks = ['find']: expected a table, by level"),
        (of_factor(labels={"plain": 5}),
         "design.factors[0].labels.plain = 5: expected a text"),
        (of_factor(labels=7), "design.factors[0].labels = 7: expected a table, by level"),
        (of_factor(name="time"),
         "design.factors[0].name = 'time': expected a name that is no fixed column"),
        ({"factors": [VIEWS, VIEWS]}, "design.factors = 'view': expected each name once"),
        (of_measure(scale="length"),
         "design.tasks[0].measures[0].scale = 'length': expected one of ratio, count, bounded"),
        (of_measure(margin=0.9),
         "design.tasks[0].measures[0].margin = 0.9: expected a number above 1"),
        (of_measure(log="yes"),
         "design.tasks[0].measures[0].log = 'yes': expected true or false"),
        ({"excluded": [{"view": "none"}]},
         "design.excluded[0].view = 'none': expected a level of view"),
        ({"predictions": [{"name": "H", "measure": "time", "contrast": "light"}]},
         "design.predictions[0].contrast = 'light': expected a factor: view"),
        ({"predictions": [{"name": "H", "measure": "time", "margin": 0.8}]},
         "design.predictions.margin.time = 0.8: expected a number above 1"),
        ({"predictions": [{"name": "H", "measure": "tiem", "margin": 2}]},
         "design.predictions.margin = 'tiem': expected a measure: time"),
        ({"predictions": [{"name": "H", "measure": "time", "expect": "better"}]},
         "design.predictions[0].expect = 'better': expected one of less, more, different"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_one_line(entry, line):
    with pytest.raises(DataError) as caught:
        read(**entry)
    assert any(line in said for said in caught.value.lines), caught.value.lines


def test_a_level_s_only_task_is_no_list_of_letters():
    (factor,) = read(**of_factor(tasks={"plain": "find", "xray": ["find", "count"]})).factors
    assert factor.tasks == {"plain": ("find",), "xray": ("find", "count")}


def test_a_margin_is_of_the_measure_that_has_the_column():
    """A prediction may name a measure by its column; its margin belongs to it all the same."""
    about = of_measure(name="duration", column="time", log=True)
    stated = {"name": "H", "measure": "time", "expect": "equivalent", "margin": 1.5}
    design = read(**about, predictions=[stated])
    assert next(m.margin for t in design.tasks for m in t.measures) == 1.5


def test_all_that_is_wrong_is_said_at_once():
    with pytest.raises(DataError) as caught:
        read(**of_factor(kind="beside", baseline="none"))
    assert len(caught.value.lines) == 2


SMALL = Design((VIEWS,), (3,), 1, measures=(TIME, RIGHT))


def unchained(folder):
    """The tables of a made folder without their chains, so that a cell can be changed."""
    for table in folder.glob("data/human/*/*_trials_data.csv"):
        rows = [line.rpartition(",")[0] for line in table.read_text().split("\n")[:-1]]
        table.write_text("\n".join(rows) + "\n")
        sidecar = table.with_suffix(".json")
        about = json.loads(sidecar.read_text())
        del about["chain"]
        sidecar.write_text(json.dumps(about))
        for end in table.parent.glob("*_end.json"):
            end.unlink()
    return folder


def refused(folder, *wanted):
    with pytest.raises(DataError) as caught:
        load_study(folder)
    for line in wanted:
        assert any(line in said for said in caught.value.lines), caught.value.lines


def test_sessions_of_two_designs_are_no_study(tmp_path):
    folder = unchained(make_design(tmp_path / "d", SMALL))
    sidecar = sorted(folder.glob("data/human/P02/*_trials_data.json"))[0]
    about = json.loads(sidecar.read_text())
    about["design"]["factors"][0]["baseline"] = "cut"
    sidecar.write_text(json.dumps(about))
    refused(
        folder,
        "P02_session-1_trials_data.json: design: expected the one of",
    )


def test_a_level_that_the_design_lacks_is_named_by_row(tmp_path):
    folder = unchained(make_design(tmp_path / "d", SMALL))
    table = sorted(folder.glob("data/human/P01/*_trials_data.csv"))[0]
    table.write_text(table.read_text().replace(",lens,", ",glass,"))
    refused(folder, "view = 'glass': expected plain, xray, cut, lens")


def test_somebody_of_two_groups_is_named_by_row(tmp_path):
    design = Design((factor("skill", "low", "high", kind="measured"), VIEWS), (2, 2), 1,
                    measures=(TIME, RIGHT))  # fmt: skip
    folder = unchained(make_design(tmp_path / "d", design))
    table = sorted(folder.glob("data/human/P01/*_trials_data.csv"))[0]
    lines = table.read_text().split("\n")
    lines[2] = lines[2].replace(",low,", ",high,")
    table.write_text("\n".join(lines))
    refused(folder, "row 3: skill = 'high': expected low, the participant's")


def test_trials_of_a_cell_that_is_left_out_are_named_by_row(tmp_path):
    whole = Design((factor("view", "plain", "cut"), factor("light", "day", "night")), (2,), 1,
                   measures=(TIME, RIGHT))  # fmt: skip
    folder = unchained(make_design(tmp_path / "d", whole))
    for sidecar in folder.glob("data/human/*/*_trials_data.json"):
        about = json.loads(sidecar.read_text())
        about["design"]["excluded"] = [{"view": "cut", "light": "night"}]
        sidecar.write_text(json.dumps(about))
    refused(folder, "view = cut, light = night: a cell that the study leaves out")


def test_the_largest_complete_table_leaves_out_as_little_as_can_be(tmp_path):
    """6 × 3 less (plain, 380): without plain 5 × 3 = 15 cells are left, without 380 6 × 2 = 12."""
    design = read_design(DESIGNS["six_by_three"].entry(), "x.json")
    import numpy as np

    from seethrough.analysis.cells import Cells

    cells = Cells(np.zeros((1, 6, 3)), np.ones((1, 6, 3), int), ("a",), design.levels)
    kept, said = complete(design, cells)
    assert kept.values.shape == (1, 5, 3) and "plain" not in kept.factors["view"]
    assert "leaves out plain × 380" in said and said.endswith("without view plain.")


def tables(report):
    return {b.key: b for s in report.sections for b in walk(s.blocks) if isinstance(b, Table)}


def test_a_task_that_only_one_group_does_has_no_groups(tmp_path):
    """A factor that is constant within a measure's rows drops out, and nobody lacks the other's."""
    job = factor("job", "counting", "reading", kind="between")
    design = Design((job, factor("view", "plain", "cut")), (5, 4), 2, ("count", "read"),
                    (TIME, RIGHT))  # fmt: skip
    folder = unchained(make_design(tmp_path / "d", design))
    for table in folder.glob("data/human/*/*_trials_data.csv"):
        lines = table.read_text().split("\n")
        kept = [x for x in lines if not (",counting," in x and ",read," in x)]
        kept = [x for x in kept if not (",reading," in x and ",count," in x)]
        table.write_text("\n".join(kept))
    report = make_report(folder, Options())
    found = tables(report)
    sizes = {r["contrast"]: r["n"] for r in found["contrasts_log_time"].rows}
    assert sizes == {"count/view=cut": 5, "read/view=cut": 4}
    assert "missing" not in found
    assert "No participant lacks a cell" in as_markdown(report)


def test_without_predictions_everything_is_exploratory(tmp_path):
    text = as_markdown(make_report(make_design(tmp_path / "d", SMALL), Options()))
    assert "The study stated no prediction: everything below is exploratory." in text


def test_the_adapter_knows_the_four_tasks():
    design = design_before({})
    assert design.task_names == ("count", "pattern", "unique", "count_in_building")
    assert [f.name for f in design.crossed] == ["transparency"]
    assert [f.name for f in design.nesting] == ["scenario"]
