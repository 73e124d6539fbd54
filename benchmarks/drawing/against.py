"""What a change costs: frames of this code and of an older commit, one after the other.

`python -m seethrough.benchmarks.drawing.against COMMIT [--turns N]`, in a clone with that commit.
Both draw the same views in one process and one OpenGL context, in turns, so that whatever else the
machine does meets both alike. For each scene and technique it prints the ratio of their times, this
code's over the commit's, each the sum over all views of the median over the turns, and a 95 %
interval from turns drawn again (percentile bootstrap).
"""

from __future__ import annotations

import argparse
import io
import subprocess
import sys
import tarfile
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.renderer.techniques.base import Parameters

PACKAGES = ("seethrough", "renderer", "tasks", "experiment", "analysis", "benchmarks")
# Where modules lie, and where they lay before, the latest place first.
DYNAMIC = ("renderer.techniques.dynamic.dynamic_transparency", "renderer.techniques.dynamic")
STANDARD = ("renderer.techniques.standard.opaque", "renderer.techniques.standard")
ABSTRACT = ("tasks.worlds.abstract.abstract_scene", "tasks.abstract_scene")
CONTROLS = ("tasks.kit.controls", "tasks.controls")
VIEWED = ("benchmarks.drawing.scenes", "benchmarks.scenes")
SIZE, VIEWS, TURNS, DRAWN_AGAIN = (800, 600), 6, 24, 2000
SCENES, SEEDS = ("abstract", "walkthrough", "jeep"), range(1, 9)


class Tree:
    """The packages of one folder: what they import, while they are `active`, are their own.

    Commits from before decisions/0013 have the rooms at the top, without `seethrough.`.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self._modules = str(folder), dict[str, ModuleType]()
        self._package = (folder / "seethrough").is_dir()

    @contextmanager
    def active(self) -> Iterator[None]:
        """Let imports, those within functions too, find this folder's packages."""
        mine = [name for name in sys.modules if name.split(".")[0] in PACKAGES]
        others = {name: sys.modules.pop(name) for name in mine}
        sys.modules.update(self._modules)
        sys.path.insert(0, self.folder)
        try:
            if self._package:  # the rooms lie beside the package, in the same folder
                import_module("seethrough").__path__.append(self.folder)
            yield
        finally:
            sys.path.remove(self.folder)
            mine = [name for name in sys.modules if name.split(".")[0] in PACKAGES]
            self._modules = {name: sys.modules.pop(name) for name in mine}
            sys.modules.update(others)

    def draws(self, context: Context) -> dict[str, list[Callable[[], None]]]:
        """What draws each view of each scene and technique with this folder's code."""
        with self.active():
            made = self._get(VIEWED, "SCENES")
            dynamic = self._get(DYNAMIC, "DynamicTransparency")
            abstract_scene = self._get(ABSTRACT, "abstract_scene")
            orbit = self._get(CONTROLS, "orbit")
            parameters = self._get(ABSTRACT, "AbstractParameters")()
            renderer = self._get(("renderer.gpu.renderer",), "Renderer")(
                context, SIZE, without=frozenset({"still"})
            )
            views: dict[str, list[tuple[object, object]]] = {}
            for name in SCENES:
                scene, cameras = made[name](SIZE[0] / SIZE[1], VIEWS)
                views[name] = [(scene, camera) for camera in cameras]
            views["abstract worlds"] = [
                (
                    abstract_scene(np.random.default_rng(seed), parameters),
                    orbit(parameters, SIZE[0] / SIZE[1], float(seed)).camera(),
                )
                for seed in SEEDS
            ]
            techniques = {
                "standard": self._get(STANDARD, "Standard")(),
                "default": dynamic(),
                "exact": dynamic(exact=True),
            }
        return {
            f"{name}, {way}": [self._draw(renderer, *view, technique) for view in found]
            for name, found in views.items()
            for way, technique in techniques.items()
        }

    def _get(self, modules: Sequence[str], name: str) -> Any:
        """A name of a module, where it lies in this folder's commit."""
        for module in modules:
            path = f"seethrough.{module}" if self._package else module
            try:
                return getattr(import_module(path), name)
            except (ModuleNotFoundError, AttributeError) as error:
                missing = error
        raise missing

    def _draw(
        self, renderer: Any, scene: object, camera: object, technique: Parameters
    ) -> Callable[[], None]:
        return lambda: renderer.draw(scene, camera, technique)


def spent(
    trees: tuple[Tree, Tree], draws: Any, context: Context, turns: int
) -> NDArray[np.float64]:
    """(2, turns, views) seconds of both trees; which one begins changes with the turn."""
    found = np.zeros((2, turns, len(draws[0])))
    for turn in range(-1, turns):  # the first turn compiles and uploads
        for view in range(len(draws[0])):
            for which in (0, 1) if turn % 2 else (1, 0):
                with trees[which].active():
                    start = time.perf_counter()
                    draws[which][view]()
                    context.finish()
                    found[which, turn, view] = time.perf_counter() - start
    return found


def ratio(seconds: NDArray[np.float64]) -> float:
    """The second tree's time over the first's: sums of medians."""
    first, second = np.median(seconds, axis=1).sum(axis=1)
    return float(second / first)


def interval(seconds: NDArray[np.float64], rng: np.random.Generator) -> tuple[float, float]:
    """95 % of the ratios with as many turns drawn again."""
    turns = seconds.shape[1]
    drawn = [ratio(seconds[:, rng.integers(turns, size=turns)]) for _ in range(DRAWN_AGAIN)]
    low, high = np.percentile(drawn, [2.5, 97.5])
    return float(low), float(high)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commit")
    parser.add_argument("--turns", type=int, default=TURNS)
    args = parser.parse_args()
    here = Path(__file__).resolve().parents[2]
    found = subprocess.run(["git", "archive", args.commit], cwd=here, capture_output=True)
    if found.returncode:
        parser.error(f"{args.commit}: {found.stderr.decode().strip()}; expected a commit")
    with tempfile.TemporaryDirectory() as folder:
        tarfile.open(fileobj=io.BytesIO(found.stdout)).extractall(folder, filter="data")
        trees = (Tree(Path(folder)), Tree(here))
        with trees[1].active():
            context = import_module("seethrough.renderer.gpu.device.context").standalone()
        both = [tree.draws(context) for tree in trees]
        for name in both[0]:
            seconds = spent(trees, [draws[name] for draws in both], context, args.turns)
            low, high = interval(seconds, np.random.default_rng(0))
            print(f"{name}: {ratio(seconds):.3f} ({low:.3f} to {high:.3f})", flush=True)


if __name__ == "__main__":
    main()
