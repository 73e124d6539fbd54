"""`demo`: where it plays, what it opens, and what its exit status says."""

from __future__ import annotations

import argparse
from pathlib import Path

import pytest

from seethrough.experiment import cli
from seethrough.experiment.commands.sessions import demo


@pytest.fixture
def told(monkeypatch):
    """What the command did: its sessions, its report, the pages it opened."""
    done = {"window": [], "offscreen": [], "report": [], "opened": [], "made": 0, "desktop": True}
    monkeypatch.setattr(demo, "_desktop", lambda: done["desktop"])
    monkeypatch.setattr(demo, "_in_window", lambda *a: done["window"].append(a) or "complete")
    monkeypatch.setattr(demo, "_offscreen", lambda *a: done["offscreen"].append(a) or "complete")
    monkeypatch.setattr(cli, "main", lambda words: done["report"].append(words) or done["made"])
    monkeypatch.setattr(demo.webbrowser, "open", done["opened"].append)
    return done


def ran(*words):
    parser = argparse.ArgumentParser()
    demo.add_arguments(parser)
    return demo.run(parser.parse_args([*map(str, words)]))


@pytest.mark.parametrize("desktop", [True, False])
@pytest.mark.parametrize("quiet", [True, False])
def test_the_report_is_opened_where_there_is_a_desktop_and_nobody_said_no(
    told, tmp_path, desktop, quiet, capsys
):
    told["desktop"] = desktop
    assert ran("--out", tmp_path, *(["--no-open"] if quiet else [])) == 0
    report = (tmp_path / "report" / "report.html").resolve()
    assert told["opened"] == ([report.as_uri()] if desktop and not quiet else [])
    assert told["window"] == ([(tmp_path / "data", False, 8.0)] if desktop else [])
    assert told["offscreen"] == ([] if desktop else [(tmp_path / "data",)])
    assert told["report"] == [["report", str(tmp_path / "data"), "--out", str(tmp_path / "report")]]
    said = capsys.readouterr()
    assert said.out == f"session complete; report: {report}\n"
    assert ("no display" in said.err) == (not desktop)


def test_without_a_report_nothing_is_opened_and_the_status_is_its(told, tmp_path, capsys):
    told["made"] = 2
    assert ran("--out", tmp_path) == 2
    assert told["opened"] == [] and capsys.readouterr().out == ""


def test_watching_is_passed_on(told, tmp_path):
    ran("--out", tmp_path, "--simulated", "--speed", "2.5")
    assert told["window"] == [(tmp_path / "data", True, 2.5)]


def test_the_first_folder_that_there_is_not_is_taken(tmp_path):
    assert demo._next_folder(tmp_path) == tmp_path / "demo-1"
    for name in ("demo-1", "demo-2", "demo-4"):
        (tmp_path / name).mkdir()
    assert demo._next_folder(tmp_path) == Path(tmp_path / "demo-3")
