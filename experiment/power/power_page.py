"""The answer of `seethrough power` as one HTML page: what it rests on, curves, tables."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from html import escape
from math import inf, isinf

from seethrough.experiment.power.closed import ENOUGH
from seethrough.experiment.power.decisions import Test
from seethrough.experiment.power.effects import Effect, Put
from seethrough.experiment.power.power import Point, Sized

COLUMNS = 5  # of a table, at most
STYLE = """body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;
padding:0 1rem;color:#1b1d21}table{border-collapse:collapse;font-size:.85rem;margin:1rem 0;
display:block;overflow-x:auto;white-space:nowrap}
td,th{padding:.2rem .5rem;text-align:right;border-bottom:1px solid #d5d8de;vertical-align:top}
td:first-child,th:first-child{text-align:left;white-space:normal}.note{color:#555}svg{width:100%;height:auto}
.top{background:#f4f5f7;padding:.5rem 1rem}"""


def page(
    title: str,
    effect: Effect,
    points: Sequence[Point],
    tests: Sequence[Sized],
    enough: Mapping[str, int | None],
    smallest: tuple[int, Sequence[tuple[Test, float, str]]],
    settings: str,
    command: str,
) -> str:
    """The page."""
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}'
        f"</title><style>{STYLE}</style></head><body><h1>{escape(title)}</h1>"
        f'<div class="top"><p><b>Drawn.</b> {escape(effect.drawn)}</p>'
        f"<p><b>Assumed.</b> {escape(effect.assumed)}</p>{_gone(effect)}</div>"
        f"<p>{escape(settings)}</p>{curves(points)}"
        f"<h2>Predictions</h2>{_predictions(effect, points, enough)}"
        f"<h2>Their tests</h2>{_tests(effect, tests)}"
        f"{_smallest(*smallest)}"
        '<p class="note">Power: share of drawn studies in which the report would call the '
        "prediction supported (significant, with the predicted sign), with its 95 % "
        "Clopper–Pearson interval. Type S: of what is significant, the share with the wrong sign. "
        "Type M: how many times too large significant estimates are. n for 80 % of a test is the "
        "noncentral t's; its interval (95 %) carries the doubt of the people it rests on, and ∞ "
        "says that no number of people may do. Scores that are skewed and spread unequally reject "
        "more often than α says: where raw values have s.d. of .8 and .3 of equal means, in .11 of "
        "studies of 8, .10 of 16, .08 of 32. Times are decided by logarithms.</p>"
        f'<p class="note">Made by <code>{escape(command)}</code>. A plan, no evidence.</p>'
        "</body></html>\n"
    )


def _gone(effect: Effect) -> str:
    if not effect.alone:
        return ""
    return f"<p><b>Not asked.</b> {escape('; '.join(effect.alone))}.</p>"


def _every(points: Sequence[Point] | Sequence[Sized]) -> list[int]:
    every = sorted({p.n for p in points})
    return every[:: -(-len(every) // COLUMNS)]


def _predictions(effect: Effect, points: Sequence[Point], enough: Mapping[str, int | None]) -> str:
    sizes = _every(points)
    rows = []
    for planned in effect.planned:
        own = {p.n: p for p in points if p.name == planned.name}
        least = enough[planned.name]
        wanted = f"more than {max(own)}" if least is None else str(least)
        if least == min(own):
            wanted = f"{least} or fewer"
        needs = " (one is enough, Holm)" if planned.any else ""
        count = f"{len(planned.tests)} test{'s' * (len(planned.tests) > 1)}{needs}"
        cells = "".join(
            f"<td>{own[n].power:.3f}<br>[{own[n].low:.3f}, {own[n].high:.3f}]"
            f"<br>against {own[n].against:.3f}</td>"
            for n in sizes
        )
        said = f"{escape(planned.name)}: {escape(planned.said)}<br>{count}"
        rows.append(f"<tr><td>{said}</td><td>{wanted}</td>{cells}</tr>")
    head = "".join(f"<th>{n} people</th>" for n in sizes)
    return f"<table><tr><th>prediction</th><th>n for 80 %</th>{head}</tr>{''.join(rows)}</table>"


def _tests(effect: Effect, tests: Sequence[Sized]) -> str:
    sizes = _every(tests)
    rows = []
    for put in effect.put:
        own = {t.n: t for t in tests if t.name == put.test.name}
        cells = "".join(f"<td>{_sized(own[n])}</td>" for n in sizes)
        delta = "" if put.test.ranked and put.test.directed else f"{put.delta:.2f}"
        rows.append(
            f"<tr><td>{escape(put.test.name)}</td><td>{escape(put.said)}</td><td>{delta}</td>"
            f"<td>{_n(put)}</td>{cells}</tr>"
        )
    head = "".join(f"<th>{n} people</th>" for n in sizes)
    return (
        "<table><tr><th>test</th><th>put in<br>(level against baseline)</th>"
        f"<th>standardised</th><th>n for 80 %</th>{head}</tr>{''.join(rows)}</table>"
    )


def _n(put: Put) -> str:
    if put.test.ranked and put.test.directed:
        return "see the curve"
    text = _number(put.n)
    if put.interval is not None:
        text += f"<br>[{_number(put.interval[0])}, {_number(put.interval[1])}]"
    return text


def _number(n: float) -> str:
    return "∞" if isinf(n) else f"{n:.0f}"


def _sized(sized: Sized) -> str:
    text = f"{sized.power:.3f}"
    if sized.wrong is None or sized.exaggerated is None:
        return text
    much = "∞" if sized.exaggerated == inf else f"{sized.exaggerated:.2f}"
    return f"{text}<br>S {sized.wrong:.3f}, M {much}"


def _smallest(n: int, found: Sequence[tuple[Test, float, str]]) -> str:
    if not found:
        return ""
    rows = "".join(
        f"<tr><td>{escape(test.name)}</td><td>{least:.2f}</td><td>{escape(said)}</td></tr>"
        for test, least, said in found
    )
    return (
        f"<h2>The smallest effect that {n} people would show</h2><table><tr><th>test</th>"
        f"<th>standardised</th><th>with the spread above</th></tr>{rows}</table>"
    )


def curves(points: Sequence[Point]) -> str:
    """Power against n as an SVG element, a curve a prediction."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    with matplotlib.rc_context({"svg.hashsalt": "power", "font.size": 10}):
        figure, axes = pyplot.subplots(figsize=(9, 4.5))
        for k, name in enumerate(dict.fromkeys(p.name for p in points)):
            own = [p for p in points if p.name == name]
            n = [p.n for p in own]
            color, dashes = f"C{k % 10}", ("-", "--", ":", "-.")[k % 4]
            axes.fill_between(n, [p.low for p in own], [p.high for p in own], alpha=0.15, lw=0,
                              color=color)  # fmt: skip
            axes.plot(n, [p.power for p in own], color=color, ls=dashes, marker=".", label=name)
        axes.axhline(ENOUGH, color="0.4", lw=1, ls=":")
        axes.set(xlabel="participants", ylabel="power (predicted sign)", ylim=(0, 1.02))
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
        text = io.StringIO()
        figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None})
        pyplot.close(figure)
    return text.getvalue()[text.getvalue().index("<svg") :]
