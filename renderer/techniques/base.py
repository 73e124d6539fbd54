"""What a technique is: one object that says of itself all that others must know (decisions/0012).

Its parameters are a frozen dataclass, its state is a frozen value that events replace, and its
`rule` says of every surface at a pixel how strongly it shows. The reference (renderer/reference)
composes the exact picture from that; a painter on the GPU is held to it. No object has a state of
its own: a frame follows from scene, camera, parameters and state alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar, Generic, NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import NDArray
from typing_extensions import TypeVar

from seethrough.renderer.declared import check
from seethrough.renderer.events import Event
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.scene.scene import Scene
from seethrough.renderer.techniques.seen import Look, Surfaces

if TYPE_CHECKING:
    from seethrough.renderer.scene.projection import Boxes

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Texts = Mapping[str, Mapping[str, str]]  # language → name of a text → the text

# How what a technique touches is drawn (renderer/gpu/rules/painters.py).
MASKS = "masks"  # by levels and pixels, with a mask about each target
REMOVAL = "removal"  # in one pass that leaves out what the rule takes away
PEELS = "peels"  # surfaces that show through one another, each as strongly as the rule says

TARGET_DEPTH = "target_depth"
NEEDS = frozenset({TARGET_DEPTH})
"""Pictures that the frame makes for rules that name them in `needs`: view depth of the farthest
surface of a target that faces the viewer, 0 where there is none."""


@dataclass(frozen=True)
class Parameters:
    """What a technique may vary: a frozen dataclass whose fields declare themselves
    (renderer/declared.py). It knows its `technique`, which alone knows what they mean.

    Raises ValueError, in one line, for a value that is not allowed.
    """

    technique: ClassVar[Technique]

    def __post_init__(self) -> None:
        check(self, self.technique.title.lower())


@dataclass(frozen=True, eq=False)
class Shot:
    """What is drawn: a scene, from where, and how large (width, height in pixels). `scale` is the
    picture's size over the window's: widths in pixels of the window shrink with it. `part` (left,
    top, right, bottom in pixels): beside it nobody looks anything up; None: the whole picture.
    `covered` is what objects cover on the screen, where that is known already."""

    scene: Scene
    camera: Camera
    size: tuple[int, int]
    scale: float = 1.0
    part: tuple[int, int, int, int] | None = None
    covered: Boxes | None = None

    @cached_property
    def boxes(self) -> Boxes:
        """What objects cover on the screen."""
        from seethrough.renderer.scene.projection import screen_boxes

        if self.covered is not None:
            return self.covered
        scene = self.scene
        return screen_boxes(scene.corners, self.camera, self.size, scene.around)

    @property
    def looked_up(self) -> tuple[int, int, int, int]:
        """The part, or the whole picture."""
        return self.part or (0, 0, *self.size)

    @property
    def aspect(self) -> float:
        """Width / height."""
        return self.size[0] / self.size[1]


class Cut(NamedTuple):
    """Objects of which front faces alone show, all of them (`whole`), and those of which any part
    may go (`partly`); what is in neither is removed whole. `hole` (h, w) is the depth up to which
    what is partly removed goes at each pixel, 0 where nothing does and back faces do not show;
    None where the rule cannot say that."""

    whole: Indices
    partly: Indices
    hole: NDArray[np.float32] | None


@dataclass(frozen=True, eq=False)
class Shown:
    """What stands there in this frame: the scene, perhaps with moved transforms. Its objects keep
    their indices, meshes and flags; what a technique adds, as traces, comes after them. Where
    nothing moves it is the scene itself."""

    scene: Scene


@dataclass(frozen=True)
class Gesture:
    """What a hand does for a technique: `event` as in `takes`; the pointer goes to the `place`, in
    view units; a key is pressed so many `times`, the wheel turned by so many steps, towards the
    user below 0."""

    event: str
    place: tuple[float, float] = (0.0, 0.0)
    times: int = 1


# A technique's parameters, its state, and what it finds out for its rule: who only hands them on
# need not know what they are.
P = TypeVar("P", bound=Parameters, default=Parameters)
State = TypeVar("State", default=object)
Known = TypeVar("Known", default=object)
KnownTo = TypeVar("KnownTo", default=object)


class Technique(Protocol[P, State, Known]):
    """How a frame shows a scene. `Plain` has what most of them have in common.

    `source` is a paper's key in REFERENCES.md; `instruction` says in a sentence what it does.
    `takes` are the events it may use up: "pointer", "wheel", "second button" or "key:q". What hands
    do is read by participants: the text `controls`, and where the pointer turns the viewer
    `controls` and ".walking", of `texts`. `painter` names how it is drawn (above), `glsl` its rule
    again for that: functions

        float opacity(Surface s)   0 where it is removed
        bool opened(Surface s)     whether it shows from inside as well

    of the Surface in renderer/shaders/rule.frag, with the uniforms that `uniforms` gives and the
    pictures that `pictures` gives or `needs` names (NEEDS). What it writes into `tinted` (colour,
    share) is mixed into the surface's colour, as `Look.tint` is on the CPU. `misses`: what the
    text of Elmqvist2009 §IV-A says that the technique's kind lacks of R1 to R7, if it treats it.
    """

    name: str
    version: str
    title: str
    instruction: str
    source: str
    takes: frozenset[str]
    controls: str
    texts: Texts
    painter: str
    glsl: str
    needs: frozenset[str]
    misses: str

    @property
    def Parameters(self) -> type[P]:
        """The class of its parameters."""

    def begin(self, p: P) -> State:
        """The state before the first event."""

    def on_event(self, p: P, state: State, event: Event, shot: Shot) -> tuple[State, bool]:
        """The state after an event, and whether the event is used up."""

    def active(self, p: P) -> bool:
        """Whether what it shows depends on what hands do."""

    def reach(self, p: P, state: State, shot: Shot, point: Floats) -> tuple[Gesture, ...]:
        """What hands do so that it works at a point (3,) of the world; none where they cannot."""

    def shown(self, p: P, state: State, shot: Shot) -> Shown:
        """What stands there in this frame."""

    def touches(self, p: P, state: State, shot: Shot) -> Bools:
        """(n,) the objects whose surfaces the rule may change: more may be named, none left out."""

    def known(self, p: P, state: State, seen: Surfaces) -> Known:
        """What is not local to a pixel: all that `rule` may know beside its own pixel's rows."""

    def rule(self, p: P, state: State, seen: Surfaces, known: Known) -> Look:
        """How each surface shows."""

    def uniforms(self, p: P, state: State, shot: Shot) -> Mapping[str, object]:
        """Values of the uniforms that `glsl` declares."""

    def pictures(
        self, p: P, state: State, shot: Shot, needed: Mapping[str, NDArray[np.float32]]
    ) -> Mapping[str, NDArray[np.float32]]:
        """Name → (h, w) of the pictures that `glsl` looks up, made from those that it `needs`.
        Beside the shot's `part` they may hold anything."""

    def cut(self, shot: Shot, pictures: Mapping[str, NDArray[np.float32]], among: Indices) -> Cut:
        """What of the objects `among` (k,) that it touches has to be drawn. `pictures` are those
        that `glsl` looks up."""

    def objects(self, p: P, scene: Scene) -> NDArray[np.int64]:
        """(n,) a number of each object's, the Surface's `number` in `glsl`."""

    def drawn(self, p: P, state: State) -> P:
        """The parameters as the state has them, for a painter that knows parameters alone."""

    def sides(self, p: P) -> bool:
        """Whether back faces can show."""

    def layers(self, p: P) -> int | None:
        """How many layers are peeled at most; None: all."""

    def order(self, p: P) -> str | None:
        """The method (renderer/polygons) in whose order polygons are drawn, right or wrong; None:
        pixel by pixel."""

    def edges(self, p: P) -> Mapping[str, object]:
        """What shaders/edges.frag draws lines with along the edges of each layer; empty: none."""

    def looked_at(self, p: P) -> P:
        """The parameters with which `look` finds what is seen."""

    def __hash__(self) -> int: ...

    def exactly(self, p: P) -> P:
        """The parameters with which what is drawn is the rule at every pixel, however long it
        takes."""


class Plain(Generic[P, State, Known]):
    """What most techniques are like: no events, no state, nothing moves, nothing is touched."""

    version = "1"
    takes: frozenset[str] = frozenset()
    texts: Texts = MappingProxyType({})
    painter = REMOVAL
    needs: frozenset[str] = frozenset()
    misses = ""
    glsl = "float opacity(Surface s) { return 1.0; }\nbool opened(Surface s) { return false; }\n"
    Parameters: type[P]
    name: str

    def __init__(self) -> None:
        # Its own parameters alone come back to it, which no type can say.
        self.Parameters.technique = cast(Technique, self)

    @property
    def controls(self) -> str:
        """By the technique's name."""
        return f"{self.name}.controls"

    def begin(self, p: P) -> State | None:
        """No state."""
        return None

    def on_event(self, p: P, state: State, event: Event, shot: Shot) -> tuple[State, bool]:
        """Nothing is used up."""
        return state, False

    def active(self, p: P) -> bool:
        """Where events change a state that there is."""
        return bool(self.takes) and self.begin(p) is not None

    def reach(self, p: P, state: State, shot: Shot, point: Floats) -> tuple[Gesture, ...]:
        """The pointer goes there, where it is taken."""
        from seethrough.renderer.techniques.pointing import place_of

        place = place_of(shot, point)
        return (Gesture("pointer", place),) if place and "pointer" in self.takes else ()

    def shown(self, p: P, state: State, shot: Shot) -> Shown:
        """The scene as it is."""
        return Shown(shot.scene)

    def touches(self, p: P, state: State, shot: Shot) -> Bools:
        """Nothing."""
        return np.zeros(len(shot.scene.objects), dtype=bool)

    def known(self, p: P, state: State, seen: Surfaces) -> Known | None:
        """Nothing but what stands at a pixel."""
        return None

    def rule(self, p: P, state: State, seen: Surfaces, known: Known) -> Look:
        """Opaque front faces."""
        return Look(seen.front, np.ones(len(seen.depth)))

    def uniforms(self, p: P, state: State, shot: Shot) -> Mapping[str, object]:
        """None."""
        return {}

    def pictures(
        self, p: P, state: State, shot: Shot, needed: Mapping[str, NDArray[np.float32]]
    ) -> Mapping[str, NDArray[np.float32]]:
        """Those that it needs, as they are."""
        return needed

    def cut(self, shot: Shot, pictures: Mapping[str, NDArray[np.float32]], among: Indices) -> Cut:
        """Of all any part may go."""
        return Cut(among[:0], among, None)

    def objects(self, p: P, scene: Scene) -> NDArray[np.int64]:
        """1 what may be penetrated, 0 targets and what may not."""
        return (~(scene.targets | scene.impenetrable)).astype(np.int64)

    def drawn(self, p: P, state: State) -> P:
        """As they are."""
        return p

    def sides(self, p: P) -> bool:
        """They can."""
        return True

    def layers(self, p: P) -> int | None:
        """All."""
        return None

    def order(self, p: P) -> str | None:
        """Pixel by pixel."""
        return None

    def edges(self, p: P) -> Mapping[str, object]:
        """No lines."""
        return {}

    def looked_at(self, p: P) -> P:
        """As it is drawn."""
        return p

    def exactly(self, p: P) -> P:
        """As it is drawn."""
        return p
