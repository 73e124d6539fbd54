"""Scene tables of a study file with something wrong in them: keys, tags and items."""

import copy
import datetime

import numpy as np

SCENE = {
    "files": ["office"], "up": "y", "unit": 1.0, "move": "walk", "start": "entrance",
    "detail": 100, "fov_y": 1.0, "eye_height": 1.6, "speed": 2.0, "key_rate": 1.0,
    "tags": [{"name": "wall*", "wall": True, "importance": 0.5, "group": "walls"}],
    "items": [{"ask": "globe", "file": "office", "start": "entrance"}],
}  # fmt: skip
WRONG = {
    bool: (0, 1, "true", [True], {"x": 1}, 1.5),
    int: (1.5, "3", True, [1], -1, 10**9),
    float: ("0.5", True, [0.5], {"x": 1}, float("nan"), float("inf"), -1.0, 1e300),
    str: (3, 0.5, True, ["a"], {"x": 1}, datetime.date(2026, 1, 2)),
    list: (3, 0.5, True, "jeep", {"x": 1}, [[1]], [None], [3]),
}
FILES = (
    [],
    ["jeep", "jeep"],
    ["no such"],
    ["a.exe"],
    ["a\n.glb"],
    ["x" * 300 + ".glb"],
    ["jeep"] * 101,
)


def broken(rng: np.random.Generator) -> tuple[str, dict]:
    """What was broken, and the table; each has to be refused."""
    scene = copy.deepcopy(SCENE)
    places = [scene, scene["tags"][0], scene["items"][0]]
    table = places[int(rng.integers(len(places)))]
    key = list(table)[int(rng.integers(len(table)))]
    if rng.random() < 0.15:
        table[key + "s" if key not in ("tag", "item") else "x"] = 1
        return f"{key}s", scene
    if key == "files" and rng.random() < 0.7:
        table[key] = FILES[int(rng.integers(len(FILES)))]
        return f"files = {table[key]!r:.40}", scene
    wrong = WRONG[type(table[key])]
    table[key] = wrong[int(rng.integers(len(wrong)))]
    return f"{key} = {table[key]!r:.40}", scene
