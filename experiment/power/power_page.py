"""The answer of `seethrough power` as one HTML page: curves, table, and what it rests on."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from html import escape

from seethrough.experiment.power.power import ENOUGH, Power

COLUMNS = 5  # of the table, at most
STYLE = """body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;
padding:0 1rem;color:#1b1d21}table{border-collapse:collapse;font-size:.85rem;white-space:nowrap}
td,th{padding:.2rem .5rem;text-align:right;border-bottom:1px solid #d5d8de}
td:first-child,th:first-child{text-align:left}.note{color:#555}svg{width:100%;height:auto}"""


def page(
    title: str, what: str, points: Sequence[Power], enough: Mapping[str, int | None], command: str
) -> str:
    """The page. `what` says in a sentence where the participants come from."""
    every = sorted({p.n for p in points})
    sizes = every[:: -(-len(every) // COLUMNS)]
    head = "".join(f"<th>{n}</th>" for n in sizes)
    rows = "".join(_row(name, points, sizes, enough[name]) for name in enough)
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}'
        f"</title><style>{STYLE}</style></head><body><h1>{escape(title)}</h1>"
        f"<p>{escape(what)}</p>{curves(points)}"
        f"<table><thead><tr><th>test</th><th>n for 80 %</th>{head}</tr></thead>"
        f"<tbody>{rows}</tbody></table>"
        '<p class="note">Cells: share of replications in which the test was significant, with its '
        "95 % Clopper–Pearson interval; exact: the noncentral F, where differences are normal; for "
        "Friedman's exact test of two levels the trinomial of better, worse and equal. "
        "Smallest n from which power stays at 80 %, by the closed form where there is one.</p>"
        f'<p class="note">Made by <code>{escape(command)}</code>. A plan, no evidence: no person '
        "took part.</p></body></html>\n"
    )


def _row(name: str, points: Sequence[Power], sizes: Sequence[int], least: int | None) -> str:
    own = {p.n: p for p in points if p.effect == name}
    wanted = f"more than {max(p.n for p in points)}" if least is None else str(least)
    if least == min(p.n for p in points):
        wanted = f"{least} or fewer"
    cells = "".join(_cell(own[n]) for n in sizes)
    return f"<tr><td>{escape(name)}</td><td>{wanted}</td>{cells}</tr>"


def _cell(point: Power) -> str:
    exact = "" if point.exact is None else f"<br>exact {point.exact:.3f}"
    return f"<td>{point.found:.3f}<br>[{point.low:.3f}, {point.high:.3f}]{exact}</td>"


def curves(points: Sequence[Power]) -> str:
    """Power against n as an SVG element."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    with matplotlib.rc_context({"svg.hashsalt": "power", "font.size": 10}):
        figure, axes = pyplot.subplots(figsize=(9, 5))
        for k, name in enumerate(dict.fromkeys(p.effect for p in points)):
            own = [p for p in points if p.effect == name]
            n = [p.n for p in own]
            color, dashes = f"C{k % 10}", "-" if k < 10 else "--"
            axes.fill_between(n, [p.low for p in own], [p.high for p in own], alpha=0.15, lw=0)
            axes.plot(n, [p.found for p in own], color=color, ls=dashes, marker=".", label=name)
        axes.axhline(ENOUGH, color="0.4", lw=0.8, ls="--")
        axes.set(xlabel="participants", ylabel="power", ylim=(0, 1.02))
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
        text = io.StringIO()
        figure.savefig(text, format="svg", bbox_inches="tight", metadata={"Date": None})
        pyplot.close(figure)
    svg = text.getvalue()
    return svg[svg.index("<svg") :]
