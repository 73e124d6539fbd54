"""Error against time of every way of drawing translucent polygons, as an SVG for a page.

Ink and paper follow the reader's light or dark theme; marks are of colours that show on both.
"""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.benchmarks.rows import Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Matplotlib draws with these two; the SVG then names them, so that a theme can change them.
INK, PAPER = "#1f2328", "#fffffe"
THEME = """<style>
svg {{ --ink: {ink}; --paper: {paper} }}
@media (prefers-color-scheme: dark) {{ svg {{ --ink: #d8dee4; --paper: #15191f }} }}
</style>"""
LEAST = 0.01  # of 255: half floats hold no more, and a logarithm no zero
# Family: colour, and whether its members are one way with more and more passes.
FAMILIES = {
    ("bsp", "feudal"): ("#2f81d6", False),
    ("boxes",): ("#c2750a", False),
    ("distance", "view depth", "axis tree"): ("#2e9e4f", False),
    ("unsorted", "weighted", "exact"): ("#8a8f98", False),
    ("depth peeling",): ("#d64f86", True),
    ("stochastic",): ("#8f6fe0", True),
}
MARKS = "os^D"


def error_against_time(results: list[Row], path: Path) -> None:
    """One panel for each scene: time of a frame to the right, error upwards, down left is best."""
    from matplotlib.figure import Figure

    names = list(dict.fromkeys(r["scene"] for r in results))
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    figure = Figure(figsize=(9.6, 2.75 * rows + 0.2), layout="constrained", facecolor=PAPER)
    panels = figure.subplots(rows, columns, sharey=True, squeeze=False).ravel()
    for axes, name in zip(panels, names, strict=False):
        _panel(axes, [r for r in results if r["scene"] == name])
        axes.set_title(name, color=INK, fontsize=10)
    for axes in panels[len(names) :]:
        axes.remove()
    figure.supxlabel("time of a frame in ms: ordering and drawing", color=INK, fontsize=10)
    figure.supylabel("error (RMSE of a channel, in 1/255)", color=INK, fontsize=10)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside right upper", fontsize=8, labelcolor=INK, frameon=False
    )
    save(
        figure, path, "Error against time of a frame for every way of drawing translucent polygons"
    )


def _panel(axes: Axes, results: list[Row]) -> None:
    for starts, (color, chained) in FAMILIES.items():
        members = [r for r in results if r["way"].startswith(starts)]
        times = [r["frame_ms"] for r in members]
        errors = [max(r["rmse"], LEAST) for r in members]
        if chained and members:
            numbers = [r["way"].rpartition(" ")[2] for r in members]
            label = f"{starts[0]}, {', '.join(numbers)}"
            axes.plot(times, errors, "-o", color=color, ms=4, lw=1, label=label)
            for number, x, y in zip(numbers, times, errors, strict=True):
                axes.annotate(
                    number, (x, y), (3, 3), textcoords="offset points", fontsize=6.5, color=INK
                )
            continue
        for mark, r, x, y in zip(MARKS, members, times, errors, strict=False):
            axes.plot(x, y, mark, color=color, ms=6, mec=PAPER, mew=0.5, label=r["way"])
    plain(axes)
    axes.set(xscale="log", yscale="log")
    axes.xaxis.set_minor_formatter("")  # a span of one decade or two: its ends say enough


def plain(axes: Axes) -> None:
    """Ink for the frame, a faint grid."""
    axes.set_facecolor(PAPER)
    axes.tick_params(which="both", color=INK, labelcolor=INK, labelsize=8)
    for spine in axes.spines.values():
        spine.set_color(INK)
        spine.set_linewidth(0.6)
    axes.grid(color=INK, alpha=0.15, lw=0.5)


def save(figure: Figure, path: Path, title: str) -> None:
    """As an SVG whose text is text and whose colours follow the theme; the same each time.

    A name that ends in .png gives a PNG.
    """
    import matplotlib

    if path.suffix == ".png":
        figure.savefig(path, dpi=150)
        return
    written = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": path.name}):
        figure.savefig(written, format="svg", metadata={"Date": None, "Creator": None})
    text = written.getvalue()
    text = text.replace(INK, "var(--ink)").replace(PAPER, "var(--paper)")
    start = text.index(">", text.index("<svg")) + 1
    head = f"\n<title>{title}</title>\n{THEME.format(ink=INK, paper=PAPER)}"
    path.write_text(text[:start] + head + text[start:], "utf-8")
