"""Which way of drawing translucent polygons to pick when, put in words from measured results."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from seethrough.benchmarks.rows import Row

EXACT = 0.1  # per cent of the pixels that may be more than 1/255 off, as issue 3 has it
NOTICEABLE = 0.05  # of 255: closer pictures count as equal


class Results:
    """Errors and times by way and scene; times of a frame as multiples of drawing unsorted."""

    def __init__(self, results: Iterable[Row]) -> None:
        self.by: dict[str, dict[str, Row]] = {}
        for result in results:
            self.by.setdefault(result["way"], {})[result["scene"]] = result

    def column(self, way: str, what: str) -> list[float]:
        """One value for each scene."""
        return [result[what] for result in self.by[way].values()]

    def cost(self, way: str) -> float:
        """Time of a frame over that of drawing unsorted: geometric mean over the scenes."""
        ratio = np.array(self.column(way, "frame_ms")) / self.column("unsorted", "frame_ms")
        return float(np.exp(np.log(ratio).mean()))

    def exact_in(self, way: str) -> list[str]:
        """Scenes in which nearly every pixel is right."""
        return [name for name, result in self.by[way].items() if result["over"] <= EXACT]

    def exact(self, way: str) -> bool:
        """Whether that holds in every scene."""
        return len(self.exact_in(way)) == len(self.by[way])

    def named(self, *starts: str) -> list[str]:
        """Ways whose names begin so."""
        return [way for way in self.by if way.startswith(starts)]

    def span(self, way: str, what: str) -> str:
        """Least to largest value over the scenes."""
        values = self.column(way, what)
        return f"{short(min(values))}–{short(max(values))}"

    def beaten(self, way: str) -> bool:
        """Whether another way is no farther off and quicker in every scene."""
        return any(
            other != way
            and all(
                mine["rmse"] + NOTICEABLE >= self.by[other][name]["rmse"]
                and mine["over"] + EXACT >= self.by[other][name]["over"]
                and mine["frame_ms"] > self.by[other][name]["frame_ms"]
                for name, mine in self.by[way].items()
            )
            for other in self.by
        )


def short(value: float) -> str:
    """Two digits, without an exponent."""
    return f"{value:.0f}" if value >= 100 else f"{value:.2g}"


def advice(results: list[Row]) -> str:
    """One paragraph. Raises KeyError if "unsorted" was not measured."""
    found = Results(results)
    parts = [_still(found), _moving(found), _rough(found), _without(found), _never(found)]
    return " ".join(part for part in parts if part)


def _still(found: Results) -> str:
    exact = [way for way in found.named("bsp", "feudal") if found.exact(way)]
    if not exact:
        return "No order of polygons is exact in every scene."
    exact.sort(key=lambda way: max(found.column(way, "prepare_ms")))
    first, *others = exact
    text = (
        f"Polygons that stand still, intersecting or not: {first}, at most "
        f"{max(found.column(first, 'over')):.2g} % of the pixels off, at "
        f"{found.cost(first):.2g} × the time of drawing unsorted, after "
        f"{found.span(first, 'prepare_ms')} ms of preparation."
    )
    if others:
        rest = ", ".join(f"{way} ({found.cost(way):.2g} ×)" for way in others)
        longest = max(max(found.column(way, "prepare_ms")) for way in others)
        text += f" As exact, prepared in up to {short(longest)} ms: {rest}."
    return text


def _moving(found: Results) -> str:
    ways = found.named("boxes, by plane")
    if not ways:
        return ""
    way = ways[0]
    apart = found.exact_in(way)
    else_off = [r["rmse"] for name, r in found.by[way].items() if name not in apart]
    text = (
        f"Things that move: {way}, at {found.cost(way):.2g} ×, exact where they are convex and "
        f"apart ({', '.join(apart)})"
    )
    if else_off:
        text += f", up to {max(else_off):.2g}/255 off where they are not"
    return text + "."


def _rough(found: Results) -> str:
    ways = found.named("distance", "view depth", "axis tree")
    if not ways:
        return ""
    best = min(ways, key=lambda way: np.mean(found.column(way, "rmse")))
    gain = np.mean(found.column("unsorted", "rmse")) / np.mean(found.column(best, "rmse"))
    return (
        f"When a wrong blend here and there does no harm: {best}, "
        f"{found.span(best, 'rmse')}/255 off, {gain:.2g} × nearer than unsorted, at "
        f"{found.cost(best):.2g} ×."
    )


def _without(found: Results) -> str:
    texts = []
    peeling = [way for way in found.named("depth peeling") if found.exact(way)]
    if peeling:
        texts.append(f"{peeling[0]} passes, exact at {found.cost(peeling[0]):.2g} ×")
    else:
        texts += [f"depth peeling never exact with {way[15:]}" for way in found.named("depth")[-1:]]
    for way in found.named("exact list"):
        texts.append(f"the {way}, always right, at {found.cost(way):.2g} × (OpenGL 4.3)")
    for way in [*found.named("weighted"), *found.named("stochastic")[-1:]]:
        texts.append(f"{way}, {found.span(way, 'rmse')}/255 off at {found.cost(way):.2g} ×")
    return "Without any order: " + "; ".join(texts) + "." if texts else ""


def _never(found: Results) -> str:
    beaten = [way for way in found.by if found.beaten(way)]
    if not beaten:
        return ""
    return (
        f"Preparation aside, another is as right and quicker in every scene: {'; '.join(beaten)}."
    )
