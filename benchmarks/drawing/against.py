"""What a change costs: frames of this code and of an older commit, one after the other.

`python -m seethrough.benchmarks.drawing.against COMMIT [--turns N]`, in a clone with that commit.
Both draw the same views in turns, frame by frame, so that whatever else the machine does meets both
alike; each in a process of its own, for Numba takes records of two classes of one name for one
another, and looks for the right one at every call of whichever came second. For each scene and
technique it prints the ratio of their times, this code's over the commit's, each the sum over all
views of the median over the turns, and a 95 % interval from turns drawn again (percentile
bootstrap).

A process that draws is this file run as a script, `against.py --draw FOLDER`: it imports nothing of
the package that it lies in, but the one in FOLDER.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from seethrough.renderer.arrays import Floats

# Where modules lie, and where they lay before, the latest place first.
DYNAMIC = ("renderer.techniques.dynamic.dynamic_transparency", "renderer.techniques.dynamic")
STANDARD = ("renderer.techniques.standard.opaque", "renderer.techniques.standard")
ABSTRACT = ("tasks.worlds.abstract.abstract_scene", "tasks.abstract_scene")
CONTROLS = ("tasks.kit.controls", "tasks.controls")
VIEWED = ("benchmarks.drawing.scenes", "benchmarks.scenes")
CONTEXT = ("renderer.gpu.device.context", "renderer.gpu.context")
SIZE, VIEWS, TURNS, DRAWN_AGAIN = (800, 600), 6, 24, 2000
SCENES, SEEDS = ("abstract", "walkthrough", "jeep"), range(1, 9)


class Tree:
    """The packages of one folder. Commits from before decisions/0013 have the rooms at the top,
    without `seethrough.`."""

    def __init__(self, folder: Path) -> None:
        sys.path.insert(0, str(folder))
        self._package = (folder / "seethrough").is_dir()
        if self._package:  # the rooms lie beside the package, in the same folder
            import_module("seethrough").__path__.append(str(folder))

    def get(self, modules: Sequence[str], name: str) -> Any:
        """A name of a module, where it lies in this folder's commit."""
        for module in modules:
            path = f"seethrough.{module}" if self._package else module
            try:
                return getattr(import_module(path), name)
            except (ModuleNotFoundError, AttributeError) as error:
                missing = error
        raise missing

    def views(self) -> dict[str, list[tuple[object, object]]]:
        """Scenes and cameras by name."""
        made = self.get(VIEWED, "SCENES")
        abstract_scene = self.get(ABSTRACT, "abstract_scene")
        orbit = self.get(CONTROLS, "orbit")
        parameters = self.get(ABSTRACT, "AbstractParameters")()
        shape = SIZE[0] / SIZE[1]
        found: dict[str, list[tuple[object, object]]] = {}
        for name in SCENES:
            scene, cameras = made[name](shape, VIEWS)
            found[name] = [(scene, camera) for camera in cameras]
        found["abstract worlds"] = [
            (
                abstract_scene(np.random.default_rng(seed), parameters),
                orbit(parameters, shape, float(seed)).camera(),
            )
            for seed in SEEDS
        ]
        return found


def draw(folder: Path) -> None:
    """Print a line for each scene and technique, its number of views and its name, and an empty
    one; then for each line "VIEW NAME" that is read, draw that and print the seconds it took."""
    tree = Tree(folder)
    context = tree.get(CONTEXT, "standalone")()
    without = frozenset({"still"})
    renderer = tree.get(("renderer.gpu.renderer",), "Renderer")(context, SIZE, without=without)
    dynamic = tree.get(DYNAMIC, "DynamicTransparency")
    techniques = {
        "standard": tree.get(STANDARD, "Standard")(),
        "default": dynamic(),
        "exact": dynamic(exact=True),
    }
    drawn = {
        f"{name}, {way}": [(*view, technique) for view in found]
        for name, found in tree.views().items()
        for way, technique in techniques.items()
    }
    for name, views in drawn.items():
        print(len(views), name)
    print(flush=True)
    for line in sys.stdin:
        view, name = line.rstrip("\n").split(" ", 1)
        start = time.perf_counter()
        renderer.draw(*drawn[name][int(view)])
        context.finish()
        print(time.perf_counter() - start, flush=True)


class Drawer:
    """A process that draws; `views` are how many each name has."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        assert process.stdin is not None and process.stdout is not None  # pipes
        self._ask, self._answer = process.stdin, process.stdout
        self.views: dict[str, int] = {}
        while line := self._line():
            count, name = line.split(" ", 1)
            self.views[name] = int(count)

    def _line(self) -> str:
        line = self._answer.readline()
        if not line:
            raise RuntimeError("what draws has stopped; its own message stands above")
        return line.rstrip("\n")

    def seconds(self, name: str, view: int) -> float:
        """Draw a frame; how long that took."""
        self._ask.write(f"{view} {name}\n")
        self._ask.flush()
        return float(self._line())


@contextmanager
def drawer(folder: Path) -> Iterator[Drawer]:
    """What draws with a folder's code, as long as it is needed."""
    command = [sys.executable, __file__, "--draw", str(folder)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, cwd=folder) as process:
        yield Drawer(process)
        assert process.stdin is not None
        process.stdin.close()


def spent(drawers: Sequence[Drawer], name: str, turns: int) -> Floats:
    """(2, turns, views) seconds of both; which one begins changes with the turn."""
    views = drawers[0].views[name]
    found = np.zeros((2, turns, views))
    for turn in range(-1, turns):  # the first turn compiles and uploads
        for view in range(views):
            for which in (0, 1) if turn % 2 else (1, 0):
                found[which, turn, view] = drawers[which].seconds(name, view)
    return found


def ratio(seconds: Floats) -> float:
    """The second one's time over the first's: sums of medians."""
    first, second = np.median(seconds, axis=1).sum(axis=1)
    return float(second / first)


def interval(seconds: Floats, rng: np.random.Generator) -> tuple[float, float]:
    """95 % of the ratios with as many turns drawn again."""
    turns = seconds.shape[1]
    drawn = [ratio(seconds[:, rng.integers(turns, size=turns)]) for _ in range(DRAWN_AGAIN)]
    low, high = np.percentile(drawn, [2.5, 97.5])
    return float(low), float(high)


def main() -> None:
    """Measure and print."""
    if sys.argv[1:2] == ["--draw"]:
        draw(Path(sys.argv[2]))
        return
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("commit")
    parser.add_argument("--turns", type=int, default=TURNS)
    args = parser.parse_args()
    if args.turns < 1:
        parser.error(f"--turns: {args.turns}; expected at least 1")
    from seethrough.benchmarks.older import both_trees  # not where this file runs as a script

    with both_trees(parser, args.commit) as trees, ExitStack() as stack:
        both = [stack.enter_context(drawer(tree)) for tree in trees]
        for name in both[0].views:
            seconds = spent(both, name, args.turns)
            low, high = interval(seconds, np.random.default_rng(0))
            print(f"{name}: {ratio(seconds):.3f} ({low:.3f} to {high:.3f})", flush=True)


if __name__ == "__main__":
    main()
