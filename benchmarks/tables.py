"""Rows of `seethrough bench` as tables in Markdown, kept up to date inside a page.

A row whose scene reads `scene: way` becomes a line of a table of its scene, with a column for each
figure; all others are lines of their own. In a page, what the last run of a bench printed stands
between `<!-- bench NAME -->` and `<!-- /bench NAME -->`.
"""

from __future__ import annotations

import os
import platform
from pathlib import Path

from seethrough.benchmarks.rows import Row


def machine() -> str:
    """The machine and the driver, in a line."""
    text = f"{os.cpu_count()} cores ({platform.machine()}), Python {platform.python_version()}"
    try:
        from seethrough.renderer.gpu.device.context import standalone

        info = standalone().info
    except RuntimeError:
        return f"{text}, no OpenGL"
    return f"{text}, {info['GL_RENDERER']}, OpenGL {info['GL_VERSION']}"


def markdown(rows: list[Row]) -> str:
    """All rows as tables."""
    single = [r for r in rows if ": " not in r["scene"]]
    parts = [_plain(single)] if single else []
    for scene in dict.fromkeys(r["scene"].split(": ")[0] for r in rows if ": " in r["scene"]):
        parts.append(_pivot(scene, [r for r in rows if r["scene"].startswith(f"{scene}: ")]))
    return "\n\n".join(parts) + "\n"


def _plain(rows: list[Row]) -> str:
    lines = [
        "| figure | scene | value | must | aim | met |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for r in rows:
        value = f"{r['value']:.4g} {r['unit']}".strip()
        limits = " | ".join("" if r[k] is None else f"{r[k]:g}" for k in ("must", "aim"))
        lines.append(f"| {r['figure']} | {r['scene']} | {value} | {limits} | {_met(r)} |")
    return "\n".join(lines)


def _met(row: Row) -> str:
    if row["must"] is None:
        return ""
    return "yes" if row["met"] else "**no**"


def _pivot(scene: str, rows: list[Row]) -> str:
    """Tables for a scene: ways that share a figure stand in one."""
    ways: dict[str, dict[str, Row]] = {}
    for r in rows:
        ways.setdefault(r["scene"].split(": ", 1)[1], {})[r["figure"]] = r
    tables: list[tuple[list[str], list[str]]] = []  # figures, ways
    for way, cells in ways.items():
        for figures, found in tables:
            if len(set(figures) & set(cells)) > 1:
                figures += [f for f in cells if f not in figures]
                found.append(way)
                break
        else:
            tables.append((list(cells), [way]))
    texts = []
    for figures, found in tables:
        lines = [f"| {scene} | " + " | ".join(figures) + " |", "| --- " * (len(figures) + 1) + "|"]
        for way in found:
            texts_of = [_cell(ways[way][f]) if f in ways[way] else "" for f in figures]
            lines.append(f"| {way} | " + " | ".join(texts_of) + " |")
        texts.append("\n".join(lines))
    return "\n\n".join(texts)


def _cell(row: Row) -> str:
    text = f"{row['value']:.4g} {row['unit']}".strip()
    if row["must"] is not None:
        text += f" (must {row['must']:g}: {'met' if row['met'] else '**not met**'})"
    return text


def around(path: Path, name: str) -> tuple[str, str]:
    """What stands before a bench's mark in a page, and after its end.

    Raises ValueError if only one of the two marks is there, or the end comes first.
    """
    begin, end = _marks(name)
    old = path.read_text("utf-8") if path.exists() else ""
    before, found, rest = old.partition(begin)
    _, ended, after = rest.partition(end)
    if found and not ended:
        raise ValueError(f"{path}: {end} = missing: expected after {begin}")
    if not found and end in old:
        raise ValueError(f"{path}: {begin} = missing: expected before {end}")
    return before, after if found else "\n"


def put(path: Path, name: str, rows: list[Row]) -> None:
    """Write the tables of a bench into a page: between its marks, else at the end.

    Raises ValueError as `around` does; the page then stays as it is.
    """
    before, after = around(path, name)
    begin, end = _marks(name)
    table = f"{begin}\nOn {machine()}:\n\n{markdown(rows)}{end}"
    if before and not before.endswith("\n"):
        before += "\n"
    path.write_text(f"{before}{table}{after}", "utf-8")


def _marks(name: str) -> tuple[str, str]:
    return f"<!-- bench {name} -->", f"<!-- /bench {name} -->"
