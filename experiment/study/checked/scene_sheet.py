"""A picture of each of a study's scenes from where it is judged, and what is seen from there."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.display.looking import Looking
from seethrough.experiment.errors import InputError
from seethrough.experiment.study.checked import sheet_text
from seethrough.experiment.study.checked.contact_sheet import MARK, is_sheet
from seethrough.experiment.study.study import Study
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.scene.camera import Camera
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.catalog import WORLDS
from seethrough.tasks.kit.base import View
from seethrough.tasks.worlds.scene.scene_parameters import SceneParameters
from seethrough.tasks.worlds.scene.scene_place import ScenePlace, opened

if TYPE_CHECKING:
    from moderngl import Context

TILE, CAPTION, MARGIN, COLUMNS = (320, 240), 18, 8, 3
MOST_NAMES = 6
LARGEST, SMALLEST = 1000.0, 0.02  # metres: beyond, the unit is likely to be another


@dataclass(frozen=True, eq=False)
class SceneSeen:
    """A scene and from where it is judged: of each view, its camera, and which targets (k,) show
    there at all."""

    place: ScenePlace
    views: tuple[tuple[str, Camera, NDArray[np.bool_]], ...]

    @property
    def hidden(self) -> list[str]:
        """What may be asked for and shows in no view."""
        seen = np.any([shown for *_, shown in self.views], axis=0)
        return [self.place.names[i] for i in self.place.targets[~seen]]


def scenes_of(study: Study) -> list[tuple[SceneParameters, str]]:
    """Every scene that the study's worlds are made of."""
    return [(p, f) for p in study.places() if isinstance(p, SceneParameters) for f in p.files]


def looked_at(study: Study, context: Context, p: SceneParameters, file: str) -> SceneSeen:
    """What is seen of a scene without any technique."""
    window = (study.display.width, study.display.height)
    place, world = opened(p, file), WORLDS["scene"]
    looking = Looking(context, window)
    looking.technique = Standard()
    first = world.viewer(place, p, window[0] / window[1]).camera()
    cameras = {"the start": first, **place.cameras}
    if p.move != "fixed" or not place.cameras:
        cameras |= {f"view {k}": c for k, c in enumerate(world.views(p, first), start=1)}
    targets = place.targets
    views = tuple(
        (name, camera, looking.look(View(place.scene, camera)).pixels[targets] > 0)
        for name, camera in cameras.items()
    )
    return SceneSeen(place, views)


def described(p: SceneParameters, place: ScenePlace) -> tuple[str, str]:
    """How much there is and how large it is; and what is odd about that, if anything."""
    corners = place.scene.corners.reshape(-1, 3)
    x, y, z = np.ptp(corners, axis=0).tolist()
    objects, triangles = len(place.scene.objects), int(place.scene.triangle_counts.sum())
    text = (
        f"{place.file}: {objects} things, {len(place.targets)} of them targets, {triangles} "
        f"triangles; {x:.3g} × {y:.3g} × {z:.3g} m (wide, high, deep) with unit = {p.unit:g}, "
        f"up = {p.up}; {len(place.cameras)} cameras"
    )
    longest = max(x, y, z)
    if SMALLEST <= longest <= LARGEST:
        return text, ""
    return text, f"expected a scene of {SMALLEST:g} to {LARGEST:g} m; is `unit` right?"


def seen_lines(seen: SceneSeen) -> list[str]:
    """What is seen from where, and what from nowhere."""
    count = len(seen.place.targets)
    shares = ", ".join(f"{name}: {int(shown.sum())}" for name, _, shown in seen.views)
    lines = [f"of {count} targets show from {shares}"]
    hidden = seen.hidden
    if hidden:
        more = f" and {len(hidden) - MOST_NAMES} more" if len(hidden) > MOST_NAMES else ""
        lines.append(f"from none of these: {', '.join(hidden[:MOST_NAMES])}{more}")
    return lines + list(seen.place.notes)


def default_path(study_file: str) -> Path:
    """Where the sheet goes unless somebody says otherwise: here, by the study's name."""
    return Path(f"{Path(study_file).stem}-scenes.png")


def write(scenes: list[SceneSeen], context: Context, path: Path) -> None:
    """Draw every scene from every view. An older sheet is replaced, and nothing else is.

    Raises InputError.
    """
    from PIL import Image, ImageDraw, PngImagePlugin

    if os.path.lexists(path) and not is_sheet(path):
        raise InputError(f"{path}: exists already and is no contact sheet; expected a new file")
    rows = [-(-len(scene.views) // COLUMNS) for scene in scenes]
    step = (TILE[0] + MARGIN, TILE[1] + CAPTION + MARGIN)
    height = MARGIN + sum(CAPTION + 8 + n * step[1] for n in rows)
    sheet = Image.new("RGB", (MARGIN + COLUMNS * step[0], height), "white")
    draw, top = ImageDraw.Draw(sheet), MARGIN
    font, bold = sheet_text.font(13), sheet_text.font(17)
    renderer = Renderer(context, TILE)
    for scene, count in zip(scenes, rows, strict=True):
        title = sheet_text.fitted(scene.place.file, bold, sheet.width - 2 * MARGIN)
        draw.text((MARGIN, top), title, fill="black", font=bold)
        top += CAPTION + 8
        for k, (name, camera, shown) in enumerate(scene.views):
            left, down = MARGIN + k % COLUMNS * step[0], top + k // COLUMNS * step[1]
            renderer.draw(scene.place.scene, camera, Standard())
            sheet.paste(Image.fromarray(renderer.read().copy()), (left, down))
            text = f": {int(shown.sum())} of {len(shown)} targets"
            text = sheet_text.fitted(name, font, TILE[0] - font.getlength(text)) + text
            draw.text((left + 2, down + TILE[1] + 2), text, fill=(70, 70, 70), font=font)
        top += count * step[1]
    marked = PngImagePlugin.PngInfo()
    marked.add_text(*MARK)
    try:
        sheet.save(path, pnginfo=marked)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
