"""What every technique has to keep to (decisions/0012), tried on small scenes.

`seethrough technique check NAME` prints it, and the tests run it over every registered technique.
"""

from __future__ import annotations

import dataclasses
import re
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough import registry
from seethrough.experiment.display.display import MEANT
from seethrough.experiment.suites import technique_hands as hands
from seethrough.experiment.suites import technique_hard as hard
from seethrough.experiment.suites import technique_scenes as scenes
from seethrough.experiment.suites.finding import Finding, NothingToTest, note
from seethrough.experiment.suites.played import no_clock
from seethrough.experiment.suites.technique_hands import SIZE
from seethrough.experiment.suites.technique_scale import at_half
from seethrough.experiment.suites.technique_scenes import Case
from seethrough.experiment.suites.variants import pairwise, refused
from seethrough.renderer.declared import declared
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.plan.explain import explain
from seethrough.renderer.plan.planner import plan
from seethrough.renderer.reference.reference import ExactPicture, exact
from seethrough.renderer.reference.surfaces import surfaces
from seethrough.renderer.scene.scene import Object
from seethrough.renderer.techniques import base
from seethrough.renderer.techniques.seen import Look
from seethrough.renderer.techniques.standard.opaque import Standard

if TYPE_CHECKING:
    from moderngl import Context

    from seethrough.renderer.techniques.base import Technique

STEP = 1.0  # of 255: what a picture may differ, half of it rounding to 8 bits
LEFT_OUT = 0.02  # share of pixels too near an edge to be compared
MOST_HALVED = 12  # combinations of options drawn at half size as well
TAKES = ("pointer", "wheel", "second button")
PAINTERS = (base.MASKS, base.PEELS, base.REMOVAL)


def check(technique: Technique, context: Context, most: int = 1000) -> Iterator[Finding]:
    """Try everything on a technique. `most` combinations of options are compared with the
    reference; `context` is an OpenGL context."""
    tried = _Tried(technique, context)
    steps: dict[str, Callable[[], Finding]] = {
        "described": tried.described,
        "refuses": tried.refuses,
        "pure": tried.pure,
        "exact": partial(tried.exact, most),
        "half size": partial(tried.halved, most),
        "idle": tried.idle,
        "no state between frames": tried.kept,
        "reaches": partial(hands.reaches, technique, tried.cases[:4], tried.picture),
        "replay": partial(hands.replayed, technique, tried.cases[0]),
        "look": tried.looked,
        "explains": tried.explained,
        "cost": tried.cost,
    }
    for name, step in steps.items():
        try:
            yield step()
        except NothingToTest as why:
            yield note(name, f"nothing to test: {why}")
        except Exception as error:  # a stranger's code may raise anything
            yield Finding(name, False, f"{type(error).__name__}: {error}{registry.place_of(error)}")


def check_all(technique: Technique, context: Context) -> Iterator[Finding]:
    """Hold a technique's exact path to the reference on every scene there is: SCENES by chance,
    each with the next combination of options, and the hard ones as it is."""
    tried, variants = _Tried(technique, context), pairwise(technique.Parameters(), _options())
    cases = [*hard.twenty()]
    for k, case in enumerate(cases):
        yield tried.compared(f"exact, {case.name}", case, technique.Parameters(), SIZE, bool(k % 2))
    for k, p in enumerate(variants):
        case = cases[k % len(cases)]
        yield tried.compared(f"options {k + 1} of {len(variants)}", case, p, SIZE, bool(k % 2))
    for make in hard.HARD:
        case = make()
        yield tried.compared(f"hard, {case.name}", case, technique.Parameters(), SIZE, True, True)
    for make, size in hard.SIZES:
        name = f"hard, {size[0]} × {size[1]}"
        yield tried.compared(name, make(), technique.Parameters(), size, True, True)


def _options() -> np.random.Generator:
    return np.random.default_rng(11)


class _Tried:
    """A technique, its parameters, and what draws it."""

    def __init__(self, technique: Technique, context: Context) -> None:
        self.technique, self.context = technique, context
        self.p = technique.Parameters()
        self.cases = scenes.cases()

    def described(self) -> Finding:
        """What it says of itself."""
        technique, p = self.technique, self.p
        missing = [n for n in ("name", "version", "title", "source") if not getattr(technique, n)]
        if technique.instruction.count(".") != 1 or not technique.instruction.endswith("."):
            missing.append("instruction, one sentence")
        if technique.painter not in PAINTERS:
            missing.append(f"painter, one of {sorted(PAINTERS)}")
        strange = [t for t in technique.takes if t not in TAKES and not t.startswith("key:")]
        missing += [f"takes {t!r}, expected one of {', '.join(TAKES)} or key:q" for t in strange]
        missing += [f"a picture called {n}, one of {', '.join(sorted(base.NEEDS))}"
                    for n in sorted(technique.needs - base.NEEDS)]  # fmt: skip
        missing += list(self.unsaid())
        if p.technique is not technique:
            missing.append("parameters that know their technique (derive them from Parameters)")
        undeclared = {f.name for f in dataclasses.fields(p)} - set(declared(type(p)))
        missing += [f"a declaration of {name}" for name in sorted(undeclared)]
        said = f"{technique.title}, {technique.version}"
        return Finding("described", not missing, "; ".join(f"lacks {m}" for m in missing) or said)

    def unsaid(self) -> Iterator[str]:
        """What hands do that participants do not read of, in English and for walkers as well."""
        technique = self.technique
        yield from (f"takes the session's key {k}" for k in MEANT if f"key:{k}" in technique.takes)
        for name in (technique.controls, f"{technique.controls}.walking"):
            text = technique.texts.get("en", {}).get(name, "")
            words = set(re.findall(r"\w+", text))
            heard = {t.removeprefix("key:") for t in technique.takes} - {"pointer"}
            named_ = {t for t in heard if {t, t.upper(), t.capitalize()} & words}
            if technique.takes and not text:
                yield f"the text {name}"
            elif heard - named_:
                yield f"a word of {', '.join(sorted(heard - named_))} in the text {name}"

    def refuses(self) -> Finding:
        """Values beyond what is declared are refused."""
        taken, count = [], 0
        for name, value in refused(self.p):
            count += 1
            try:
                dataclasses.replace(self.p, **{name: value})
                taken.append(f"{name} = {value!r}")
            except ValueError:
                pass
        if not count:
            raise NothingToTest("no parameter has limits or choices")
        said = f"{', '.join(taken)} taken" if taken else f"{count} values beyond what is allowed"
        return Finding("refuses", not taken, said)

    def picture(
        self, case: Case, p: base.Parameters, state: object = None, size: tuple[int, int] = SIZE
    ) -> NDArray[np.uint8]:
        """(h, w, 3) drawn by a fresh renderer."""
        renderer = Renderer(self.context, size)
        renderer.draw(case.scene, case.camera, p, state=state)
        return renderer.read()

    def pure(self) -> Finding:
        """Asked twice, everything is the same; nothing that is passed is written into."""
        case = self.cases[0]
        shot = base.Shot(case.scene, case.camera, SIZE)
        seen, _ = surfaces(shot)
        for field in dataclasses.fields(seen):
            array = getattr(seen, field.name)
            if hasattr(array, "setflags"):
                array.setflags(write=False)
        state = hands.played(self.technique, case, self.p)
        looks = []
        try:
            for _ in range(2):
                with no_clock(self.technique):
                    known = self.technique.known(self.p, state, seen)
                    looks.append(self.technique.rule(self.p, state, seen, known))
        except ValueError as error:
            return Finding("pure", False, f"writes into what it is given ({error})")
        same = all(
            np.array_equal(getattr(looks[0], f.name), getattr(looks[1], f.name))
            for f in dataclasses.fields(Look)
        )
        touched = self.technique.touches(self.p, state, shot)
        again = self.technique.touches(self.p, state, shot)
        made = getattr(state, "__dataclass_params__", None)
        frozen = made is None or made.frozen
        holds = same and np.array_equal(touched, again) and frozen
        kind = "no state" if state is None else "state frozen"
        said = f"the same twice, {kind}" if holds else "differs when asked again"
        return Finding("pure", holds, said if frozen else "its state is no frozen dataclass")

    def compared(
        self,
        name: str,
        case: Case,
        p: base.Parameters,
        size: tuple[int, int],
        played: bool,
        any_: bool = False,
    ) -> Finding:
        """One exact picture against the reference; of a hard scene `any_` share may be left out,
        since what lies in one plane is nobody's."""
        drawn = self.technique.exactly(p)
        state = hands.played(self.technique, case, p) if played else self.technique.begin(p)
        truth = exact(case.scene, case.camera, drawn, size, state)
        apart = _apart(self.picture(case, drawn, state, size), truth)
        left = float(truth.near_edge.mean())
        said = f"within {apart:.2f} of 255, {100 * left:.2f} % left out"
        holds = apart <= STEP and (any_ or left <= LEFT_OUT)
        return Finding(name, holds, said if holds else f"{said}; {p}")

    def exact(self, most: int) -> Finding:
        """The exact picture, with every two values of two options, on every scene in turn."""
        variants = pairwise(self.p, _options())[:most]
        worst, left, where = 0.0, 0.0, ""
        for k in range(max(len(variants), len(self.cases))):
            p, case = variants[k % len(variants)], self.cases[k % len(self.cases)]
            drawn = self.technique.exactly(p)
            state = self.technique.begin(p) if k % 2 else hands.played(self.technique, case, p)
            truth = exact(case.scene, case.camera, drawn, SIZE, state)
            apart = _apart(self.picture(case, drawn, state), truth)
            edges = float(truth.near_edge.mean())
            if apart > worst or edges > max(left, LEFT_OUT):
                where = f" on {case.name}, {p}"
            worst, left = max(worst, apart), max(left, edges)
        said = (
            f"{max(len(variants), len(self.cases))} pictures within {worst:.2f} of 255 of the "
            f"reference, at most {100 * left:.2f} % of the pixels left out"
        )
        holds = worst <= STEP and left <= LEFT_OUT
        return Finding("exact", holds, said if holds else said + where)

    def halved(self, most: int) -> Finding:
        """In a picture of half the size it shows the same, widths in pixels shrunk with it."""
        variants = pairwise(self.p, _options())[: min(most, MOST_HALVED)]
        return at_half(variants, self.cases, scenes.covered(), self.context)

    def idle(self) -> Finding:
        """Where the rule changes no surface, the frame is the standard frame, byte for byte."""
        standard = Standard()
        wrong, idle = [], 0
        for case in (scenes.fixed(), *self.cases):
            shot = base.Shot(case.scene, case.camera, SIZE)
            state = self.technique.begin(self.p)
            if self.technique.shown(self.p, state, shot).scene is not case.scene:
                continue
            seen, _ = surfaces(shot)
            look = self.technique.rule(
                self.p, state, seen, self.technique.known(self.p, state, seen)
            )
            first = seen.first(seen.front)
            plain = (look.kept[first] & (look.opacity[first] == 1)).all()
            plain &= not (look.kept & ~seen.front).any()
            plain &= look.tint is None or not look.tint[look.kept, 3].any()
            if plain:
                idle += 1
                same = np.array_equal(self.picture(case, self.p), self.picture(case, standard))
                wrong += [] if same else [case.name]
        said = (
            f"differs from the standard frame on {', '.join(wrong)}"
            if wrong
            else (f"{idle} scenes without anything to do are the standard frame")
        )
        return Finding("idle", not wrong and idle > 0, said)

    def kept(self) -> Finding:
        """A frame is the same whatever was drawn before it."""
        renderer = Renderer(self.context, SIZE)
        wrong = []
        for case in (*self.cases, *reversed(self.cases)):
            for state in (
                hands.played(self.technique, case, self.p),
                self.technique.begin(self.p),
            ):
                renderer.draw(case.scene, case.camera, self.p, state=state)
                same = np.array_equal(renderer.read(), self.picture(case, self.p, state))
                wrong += [] if same else [case.name]
        said = f"differs on {', '.join(wrong)}" if wrong else f"{4 * len(self.cases)} frames"
        return Finding("no state between frames", not wrong, said)

    def looked(self) -> Finding:
        """What `look` finds of each object is the share that the reference gives it."""
        worst = 0.0
        for case in self.cases[:4]:
            p = self.technique.exactly(self.p)
            state = hands.played(self.technique, case, p)
            seen = Renderer(self.context, SIZE).look(case.scene, case.camera, p, SIZE, state)
            truth = exact(case.scene, case.camera, p, SIZE, state)
            weights = truth.weights[: len(case.scene.objects)]
            weights = np.where(weights >= 1 / 64, weights, 0).sum(axis=(1, 2))
            room = 2 + truth.near_edge.sum()
            worst = max(worst, float(np.abs(seen.area * SIZE[0] * SIZE[1] - weights).max() / room))
        said = f"areas of objects differ by at most {worst:.2f} of what edges allow"
        return Finding("look", worst <= 1, said)

    def explained(self) -> Finding:
        """Each object is named, with why it was touched or left."""
        case = self.cases[3]
        lines = explain(case.scene, plan(case.scene, case.camera, self.p, SIZE))
        named_ = [k for k, o in enumerate(case.scene.objects) if not _mentioned(lines, o, k)]
        said = f"nothing of objects {named_}" if named_ else f"{len(lines)} lines"
        return Finding("explains", not named_, said)

    def cost(self) -> Finding:
        """Its time over the standard frame's, frames interleaved; nothing is asked of it."""
        renderer = Renderer(self.context, (400, 300), without=frozenset({"still"}))
        case = self.cases[0]
        spent: tuple[list[float], list[float]] = ([], [])
        for _ in range(12):
            for times, p in zip(spent, (Standard(), self.p), strict=True):
                start = time.perf_counter()
                renderer.draw(case.scene, case.camera, p)
                self.context.finish()
                times.append(time.perf_counter() - start)
        standard, own = (float(np.median(times[2:])) for times in spent)
        return note("cost", f"{own / standard:.2f} × the standard frame at 400 × 300")


def _apart(picture: NDArray[np.uint8], truth: ExactPicture) -> float:
    apart = np.abs(picture - truth.picture * 255).max(axis=2)[~truth.near_edge]
    return float(apart.max(initial=0.0))


def _mentioned(lines: list[str], thing: Object, k: int) -> bool:
    name = f"{thing.kind or 'object'} {k}"
    return any(line.startswith(f"{name}:") for line in lines)
