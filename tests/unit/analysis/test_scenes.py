"""Scenes as a second sample: where they are one, where they are not, and what is said then.

That estimates, errors and spreads are lme4's is held by tests/study/test_designs_against_r.py.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_designs import DESIGNS, make_design
from scipy.optimize import approx_fprime

from seethrough.analysis.load.study import Study, load_study
from seethrough.analysis.mixed import mixed_model
from seethrough.analysis.report import Options, make_report, tables_of
from seethrough.analysis.scenes import FEWEST, MOST_WORK, scene_model
from seethrough.analysis.stats import reml


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("scenes") / "data"
    return load_study(make_design(folder, DESIGNS["scenes"]), None)


def test_deviance_and_gradient_agree_with_a_crossed_term() -> None:
    rng = np.random.default_rng(3)
    people, scenes = np.repeat(np.arange(6), 16), np.tile(np.repeat(np.arange(8), 2), 6)
    x = np.column_stack([np.ones(96), np.tile([-0.5, 0.5], 48)])
    y = rng.normal(size=96) + rng.normal(size=8)[scenes]
    own, crossed = reml.Term(x, np.zeros(96, np.intp), 1), reml.Term(x, scenes, 8)
    sums = reml._sums(y, np.column_stack([x, reml._spread(crossed)]), people, [own])

    def deviance(theta: np.ndarray) -> float:
        return reml._deviance(sums, [own, crossed], 1, theta)[0]

    theta = np.array([0.8, 0.1, 0.4, 0.5, -0.2, 0.3])
    slope = reml._deviance(sums, [own, crossed], 1, theta)[1]
    # a finite difference of a deviance near 300 has some five digits
    assert slope == pytest.approx(approx_fprime(theta, deviance, 1e-7), abs=1e-4)
    # the same likelihood by the whole covariance matrix
    factors = reml._factors(theta, [2, 2])
    v = np.eye(96)
    for factor, code in zip(factors, (people, scenes), strict=True):
        z = reml._spread(reml.Term(x, code, int(code.max()) + 1))
        v += z @ np.kron(np.eye(int(code.max()) + 1), factor @ factor.T) @ z.T
    inverse = np.linalg.inv(v)
    information = x.T @ inverse @ x
    beta = np.linalg.solve(information, x.T @ inverse @ y)
    rest = y - x @ beta
    s2 = rest @ inverse @ rest / 94
    logs = np.linalg.slogdet(v)[1] + np.linalg.slogdet(information)[1]
    assert deviance(theta) == pytest.approx(logs + 94 * (1 + np.log(2 * np.pi * s2)), abs=1e-8)


def test_few_shared_scenes_are_these_scenes_only(study: Study) -> None:
    kept = study.trials["scene"].astype("str").isin([f"find-{i}" for i in range(FEWEST - 1)])
    few = study.trials[kept]
    found = scene_model(few, study.design, mixed_model(few, study.design)[0])
    assert (found.shared, found.effects) == (FEWEST - 1, ())


def test_scenes_that_nobody_shares_are_none(study: Study) -> None:
    alone = study.trials.assign(scene=[f"stream-{i}" for i in range(len(study.trials))])
    found = scene_model(alone, study.design, mixed_model(alone, study.design)[0])
    assert (found.shared, found.effects, found.given_up) == (0, (), ())


def test_singular_scenes_are_given_up_by_named_steps(study: Study) -> None:
    """Shuffled among a person's trials, scenes explain nothing."""
    rng = np.random.default_rng(1)
    mixed_up = study.trials.assign(
        scene=study.trials.groupby("participant", observed=True)["scene"].transform(
            lambda s: rng.permutation(s.astype("str").to_numpy())
        )
    )
    found = scene_model(mixed_up, study.design, mixed_model(mixed_up, study.design)[0])
    assert found.given_up
    steps = [line.partition(": ")[0].rpartition(" + ")[2] for line in found.given_up]
    assert steps[0].startswith("view | scene)")
    assert all("singular" in line for line in found.given_up)


def test_a_scene_that_is_met_under_one_level_has_no_slope(study: Study) -> None:
    nested = study.trials["scene"].astype("str") + "-" + study.trials["view"].astype("str")
    own = study.trials.assign(scene=nested)
    found = scene_model(own, study.design, mixed_model(own, study.design)[0])
    assert "too few scenes were met under every level" in found.given_up[0]
    assert all(e.sd_slope is None for e in found.effects)


def test_a_fit_that_would_take_too_long_is_not_begun(
    study: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("seethrough.analysis.scenes.MOST_WORK", MOST_WORK / 1e6)
    found = scene_model(study.trials, study.design, mixed_model(study.trials, study.design)[0])
    assert not found.effects
    assert all(line.endswith("would take too long") for line in found.given_up)


def test_the_report_says_for_which_scenes_it_speaks(tmp_path: Path) -> None:
    shared = {t.key: t for t in tables_of(_report(tmp_path / "many", 8))}
    assert shared["mixed_scenes"].rows[0]["scenes"] == 8
    few = _report(tmp_path / "few", 4)
    assert "mixed_scenes" not in {t.key for t in tables_of(few)}
    assert "4 scenes were met by several people. Fewer than 7 are no sample" in _said(few)


def _said(report) -> str:
    return " ".join(
        str(run) for s in report.sections for b in s.blocks for run in getattr(b, "runs", ())
    )


def _report(folder: Path, scenes: int):
    return make_report(make_design(folder, replace(DESIGNS["scenes"], shared=scenes)), Options())


def test_scenes_enough_beside_a_model_that_was_not_fitted_are_not_called_too_few(
    tmp_path: Path,
) -> None:
    """Two people are too few for the model, whatever the scenes."""
    few = replace(DESIGNS["scenes"], people=(2,))
    report = make_report(make_design(tmp_path / "data", few), Options())
    assert "8 scenes were met by several people. The model above was not fitted" in _said(report)
    assert "no sample" not in _said(report)
