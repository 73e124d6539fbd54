"""The report as a reader meets it: a real Chromium, offline, by mouse and by keyboard."""

from __future__ import annotations

import csv
import json
import re
from importlib.resources import files
from pathlib import Path

import pytest
from browser import Browser
from made_data import Made, make_folder

from seethrough.experiment.cli import main

# details of violations only: with those of all that passes a page takes four times as long
AXE = "axe.run(document, {resultTypes: ['violations']}).then(arguments[arguments.length - 1])"
# Vega draws after the page has loaded
CHARTS = (
    "const done = arguments[arguments.length - 1]; const look = () =>"
    "document.documentElement.dataset.charts ? done() : setTimeout(look, 20); look()"
)
TAB, RIGHT = "\ue004", "\ue014"


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("browser")
    make_folder(folder / "data", Made())
    assert main(["report", str(folder / "data"), "--out", str(folder / "study")]) == 0
    assert main(["report", "--published", "--out", str(folder / "published")]) == 0
    return folder


@pytest.fixture(scope="module")
def browser():
    with Browser() as browser:
        yield browser


@pytest.fixture(params=["study", "published"])
def report(request, folder, browser) -> Path:
    browser.log("performance")
    browser.log("browser")
    browser.open(folder / request.param / "report.html")
    browser.run_async(CHARTS)
    return folder / request.param


def test_it_loads_without_network_or_console_messages(report, browser):
    asked = [
        message["params"]["request"]["url"]
        for entry in browser.log("performance")
        if (message := json.loads(entry["message"])["message"])["method"]
        == "Network.requestWillBeSent"
    ]
    outside = [url for url in asked if not url.startswith(("file:", "data:", "about:"))]
    assert [url for url in asked if url.endswith("report.html")]
    assert outside == []
    assert browser.log("browser") == []


def test_every_number_on_the_page_equals_its_csv(report, browser):
    """Table cells and numbers in sentences carry their exact value and where it is from."""
    cells = browser.run(
        "return [...document.querySelectorAll('table [data-column]')].map(c => ["
        "c.closest('table').dataset.csv, c.closest('tr').dataset.row, c.dataset.column,"
        "c.dataset.value, c.textContent]).concat("
        "[...document.querySelectorAll('data[data-from]')].map(c => ["
        "c.dataset.from, c.dataset.row, c.dataset.column, c.value, c.textContent]))"
    )
    tables: dict[str, dict[str, dict[str, str]]] = {}
    assert len(cells) > 200
    for name, row, column, value, text in cells:
        if name not in tables:
            with open(report / "tables" / name, newline="") as file:
                rows = list(csv.DictReader(file))
            key = next(iter(rows[0]))
            tables[name] = {r[key]: r for r in rows}
        assert tables[name][row][column] == value, (name, row, column)
        assert rounds(value, text), (name, row, column, value, text)


def rounds(value: str, text: str) -> bool:
    """Whether `text` is `value` as a page may print it."""
    shown = text.replace("−", "-").replace("\u00a0", " ").split(" [")[0]
    try:
        number = float(value)
    except ValueError:
        # a reason is given once in a row, then the word alone
        words = {"true": "yes", "false": "no"}
        plain = words.get(value, value)
        same = plain.replace("−", "-").replace("\u00a0", " ").split(" [")[0]
        return shown == same or (shown == "undefined" and value.startswith("undefined: "))
    if shown.startswith("<"):
        return number < float(shown[1:])
    if shown.startswith(">"):
        return number > float(shown[1:])
    raised = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    mantissa, _, power = shown.partition(" × 10")
    scale = 10.0 ** int(power.translate(raised)) if power else 1.0
    decimals = len(mantissa.partition(".")[2])
    return abs(float(mantissa) * scale - number) <= (0.5000001 * 10.0**-decimals) * scale


def test_every_figure_has_an_alternative_text(report, browser):
    figures = browser.run(
        "return [...document.querySelectorAll('figure')].map(f => ["
        "f.querySelector('[role=graphics-document]').getAttribute('aria-label'),"
        "document.getElementById(f.getAttribute('aria-labelledby')).textContent,"
        "f.querySelector('svg').getBoundingClientRect().width,"
        "f.querySelectorAll('[tabindex]').length])"
    )
    assert figures
    for text, caption, width, marks in figures:
        assert len(text) > 40 and caption and width > 300 and marks > 2


def test_a_reader_without_scripts_sees_the_drawings(folder):
    """What stands in the page before Vega has run."""
    page = (folder / "study" / "report.html").read_text(encoding="utf-8")
    drawings = re.findall(r'<div class="chart"><svg.*?</svg></div>', page, flags=re.DOTALL)
    assert len(drawings) == page.count("<figure ") > 3
    for drawing in drawings:
        assert "<desc>" in drawing and 'role="graphics-symbol"' in drawing


def test_every_table_can_be_reached_by_keyboard(report, browser):
    """Tab through the whole page, folds opened: each table's region takes the focus."""
    browser.run("document.querySelectorAll('details').forEach(d => d.open = true);")
    wanted = set(browser.run("return [...document.querySelectorAll('table')].map(t => t.id)"))
    stops = browser.run("return document.querySelectorAll('a, summary, .scroll, figure').length")
    browser.run("document.body.focus(); document.activeElement.blur();")
    met = set()
    for _ in range(stops + 5):
        browser.press(TAB)
        table = browser.run(
            "const t = document.activeElement.querySelector(':scope > table');"
            "return t ? t.id : null"
        )
        met.add(table)
        if wanted <= met:
            break
    assert wanted <= met


def test_marks_say_their_numbers_to_mouse_and_keyboard(report, browser):
    place = browser.run(
        "const m = document.querySelector('.chart [tabindex=\"0\"]');"
        "m.scrollIntoView({block: 'center', behavior: 'instant'});"
        "const b = m.getBoundingClientRect();"
        "return [b.x + b.width / 2, b.y + b.height / 2, m.getAttribute('aria-label')]"
    )
    browser.point(place[0], place[1])
    tip = (
        "const t = document.querySelector('#vg-tooltip-element.visible');"
        "return t ? t.textContent : ''"
    )
    assert browser.run(tip) == place[2]
    browser.point(2, 2)
    assert browser.run(tip) == ""
    browser.run("document.querySelector('.chart [tabindex=\"0\"]').focus()")
    assert browser.run(tip) == place[2]
    second = browser.run(
        "return document.querySelectorAll('.chart [tabindex]')[1].getAttribute('aria-label')"
    )
    browser.press(RIGHT)
    assert browser.run(tip) == second


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_serious(report, browser, scheme):
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    browser.devtools("Emulation.setEmulatedMedia", features=features)
    browser.run("document.querySelectorAll('details').forEach(d => d.open = true);")
    browser.run((files("axe_core_python") / "axe.min.js").read_text(encoding="utf-8"))
    found = browser.run_async(AXE)
    serious = [
        (v["id"], v["impact"], [n["html"][:120] for n in v["nodes"][:3]])
        for v in found["violations"]
        if v["impact"] in ("serious", "critical")
    ]
    assert serious == []
    assert len(found["passes"]) > 10


def test_light_and_dark_are_different_pages(report, browser):
    colours = []
    for scheme in ("light", "dark"):
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        browser.devtools("Emulation.setEmulatedMedia", features=features)
        colours.append(
            browser.run(
                "const b = getComputedStyle(document.body);"
                "const t = getComputedStyle(document.querySelector('.chart svg text'));"
                "return [b.backgroundColor, b.color, t.fill]"
            )
        )
    assert colours[0] != colours[1]
    assert colours[1][1] == colours[1][2]  # figures' text takes the page's colour


def test_nothing_is_wider_than_a_phone(report, browser):
    browser.devtools(
        "Emulation.setDeviceMetricsOverride",
        width=390,
        height=800,
        deviceScaleFactor=1,
        mobile=True,
    )
    widths = browser.run("return [document.documentElement.scrollWidth, window.innerWidth]")
    browser.devtools("Emulation.clearDeviceMetricsOverride")
    assert widths[0] <= widths[1]


def test_it_prints_to_pdf(folder, tmp_path):
    """`--format pdf` through the Chromium that is there."""
    out = tmp_path / "out"
    assert main(["report", "--published", "--out", str(out), "--format", "pdf"]) == 0
    data = (out / "report.pdf").read_bytes()
    assert data.startswith(b"%PDF") and len(data) > 50_000


def test_without_a_browser_pdf_says_so(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("seethrough.analysis.report.pdf.PLACES", ())
    out = tmp_path / "out"
    assert main(["report", "--published", "--out", str(out), "--format", "pdf"]) == 2
    error = capsys.readouterr().err
    assert "--format = pdf: expected Chromium, Chrome or Edge" in error and error.count("\n") == 1
    assert not out.exists()
