"""What a study may say of the world `scene`: its files, what is what in them, how one moves."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from seethrough.renderer.declared import check, key
from seethrough.renderer.models.scene_file import DETAIL, KINDS
from seethrough.tasks.kit.tags import Tag
from seethrough.tasks.kit.world import FILES

READER = 1
"""Changes with what the same file looks like, or with how a data folder keeps it."""
SHIPPED = ("assembly", "jeep", "office")
MOVES = ("orbit", "walk", "fixed")
MOST_FILES = 100


@dataclass(frozen=True)
class Item:
    """A scene and what is asked in it."""

    ask: str = key(..., "the name of the thing that is asked for")
    file: str = key(
        "", "the scene it is in, one of `files`; where there is one, it may be left out"
    )
    start: str = key("", "the file's camera from which it is looked for; none: `start`")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True)
class SceneParameters:
    """Scenes from files, and moving in them. World units are metres.

    `sha256` of the files, and the `folder` they are in, are found out when the study is read.
    """

    files: tuple[str, ...] = key(
        SHIPPED, "scenes: files beside the study, or the names of shipped ones", said="an array of "
        f"files beside the study ({', '.join(KINDS)}) or of {', '.join(SHIPPED)}, each once",
    )  # fmt: skip
    scenes: str = key(
        FILES, "whose scenes: everybody's, whose items rotate over the levels", choices=(FILES,)
    )
    up: str = key("y", "the files' upward axis", choices=("y", "z"))
    unit: float = key(1.0, "how long a unit of the files is", "m", low=1e-6, high=1e6)
    move: str = key("orbit", "turn the scene, walk in it, or step from view to view", choices=MOVES)
    about: str = key("", "what an orbit is about: a thing or empty node's name; none: the middle")
    start: str = key("", "the file's camera where one begins; none: a place before it all")
    tags: tuple[Tag, ...] = key((), "what is what in the scenes, `[[world.scene.tags]]` each")
    items: tuple[Item, ...] = key(
        (), "what is asked, in this order, `[[world.scene.items]]` each; none: every target of "
        "every file, in an order drawn from the study's seed",
    )  # fmt: skip
    detail: int = key(
        DETAIL, "most triangles to cut a mesh into for what a texture shows", low=0, high=250_000
    )
    fov_y: float = key(pi / 3, "angle of view, from bottom to top", "radians", low=0.1, high=2.5)
    start_pitch: float = key(
        0.35, "how far from above an orbit's first view looks down", "radians",
        low=-pi / 2, high=pi / 2,
    )  # fmt: skip
    drag_gain: float = key(
        pi, "turn for a drag over the height of the view", "radians", low=0.1, high=20
    )
    key_rate: float = key(
        1.0, "turn while an arrow key is held, left and right when walking", "radians/s",
        low=0.05, high=10,
    )  # fmt: skip
    eye_height: float = key(1.6, "height of the eyes when walking", "m", low=0.01, high=1000)
    speed: float = key(2.0, "walking speed", "m/s", low=0.01, high=1000)
    sha256: tuple[str, ...] = key(
        (), "the files' SHA-256, found out when the study is read; where they are set, they have "
        "to be those files'", said="an array of 64 hexadecimal digits for each file, or none",
    )  # fmt: skip
    reader: int = key(
        READER, "which of our readers shows them, found out when the study is read",
        low=1, high=1000,
    )  # fmt: skip
    folder: str = ""

    def __post_init__(self) -> None:
        check(self)
        names = self.files
        bad = [n for n in names if not _is_file(n)]
        if bad or not 1 <= len(set(names)) == len(names) <= MOST_FILES:
            raise ValueError(
                f"files = {[n[:40] for n in (bad or names)[:3]]}, expected an array of files "
                f"beside the study ({', '.join(KINDS)}) or of {', '.join(SHIPPED)}, each once"
            )
        hexadecimal = all(len(s) == 64 and set(s) <= set("0123456789abcdef") for s in self.sha256)
        if not hexadecimal or (self.sha256 and len(self.sha256) != len(names)):
            raise ValueError(
                f"sha256 = {[s[:12] for s in self.sha256[:3]]}, expected an array of 64 "
                "hexadecimal digits for each file, or none"
            )

    @property
    def controls(self) -> str:
        """The name of the text that says how one moves."""
        return f"scene.{self.move}"

    @property
    def lattice(self) -> str:
        """From which viewpoints data mode knows what is seen."""
        return "orbit" if self.move == "orbit" else "poses"


def is_shipped(file: str) -> bool:
    """Whether it names a scene of ours."""
    return file in SHIPPED


def _is_file(name: str) -> bool:
    if is_shipped(name):
        return True
    suffix = name[name.rfind(".") :].lower() if "." in name else ""
    return name.isprintable() and len(name) <= 200 and suffix in KINDS
