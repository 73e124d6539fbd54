"""A picture of each of a study's own models from several sides, with what there is to know."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from seethrough.experiment.errors import InputError
from seethrough.experiment.study.beside.own_model_files import models_of
from seethrough.experiment.study.checked import sheet_text
from seethrough.experiment.study.config import Study
from seethrough.renderer.gpu.renderer import Renderer
from seethrough.renderer.models.user import Facts
from seethrough.renderer.scene.camera import look_at
from seethrough.renderer.scene.geometry import Mesh
from seethrough.renderer.scene.scene import Object, Scene
from seethrough.renderer.scene.transforms import rotation_x, scaling
from seethrough.renderer.techniques.standard.opaque import Standard
from seethrough.tasks.kit.own_models import OwnModel, mesh_of, read
from seethrough.tasks.worlds.building.building import shown_size
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters

if TYPE_CHECKING:
    from moderngl import Context


METRE = 2.0  # world units
TILE, TEXT, MARGIN = 240, 300, 10
BACKGROUND = (1.0, 1.0, 1.0)
# Yaw about +y and pitch of where it is seen from, in degrees: 0 looks at its front.
VIEWS = {"front": (0, 8), "left front": (-40, 20), "right back": (140, 20), "above": (0, 80)}
MARK = ("Software", "seethrough check: contact sheet")
STANDS_BETTER = 3.0  # times as much of its footprint on the ground, to doubt what is up


def facts_of(own: OwnModel) -> Facts:
    """What the model's files hold."""
    return read(own)[1]


def _place(own: OwnModel, study: Study) -> BuildingParameters:
    """The parameters of the first world that has the model."""
    places = (p for p in study.places() if isinstance(p, BuildingParameters))
    return next(place for place in places if own in place.models)


def described(own: OwnModel, facts: Facts, study: Study) -> list[str]:
    """What there is to say about a model, a line each."""
    mesh = mesh_of(own)
    scale = shown_size(mesh, _place(own, study))[0] / METRE
    x, y, z = (side * scale for side in facts.size)
    lines = [f"{len(mesh.triangles)} triangles, {facts.in_file} in the file"]
    lines.append(f"{x:.2f} × {y:.2f} × {z:.2f} m (wide, high, deep) in the building")
    lines.append(_sides(facts))
    lines.append(f"colours: {facts.colors}")
    if facts.carried is not None:
        c = facts.carried
        lines.append(
            f"texture in {c.added} triangles: off by {c.mean:.1f}/255, 99 % within {c.most:.0f}/255"
            + (f"; more than detail = {own.detail} would be nearer" if c.limited else "")
        )
    lines.append(_up(own, facts))
    return lines + list(facts.notes)


def _sides(facts: Facts) -> str:
    sides = facts.sides
    if not sides.doubled and not sides.turned:
        return "closed" if sides.closed else "both sides in the file"
    parts = []
    if sides.turned:
        parts.append(f"{sides.turned} triangles inside out, turned")
    if sides.doubled:
        parts.append(f"open: both sides drawn ({sides.doubled} triangles more)")
    return "; ".join(parts if sides.doubled else ["closed", *parts])


def _up(own: OwnModel, facts: Facts) -> str:
    """The axis that points up, and whether the model would stand better on another."""
    other = "z" if own.up == "y" else "y"
    mine, others = facts.stands[own.up], facts.stands[other]
    if others > 0.05 and others > STANDS_BETTER * mine:
        return (
            f"up: {own.up}; LOOKS AS IF {other} POINTED UP: {100 * others:.0f} % of its footprint "
            f"would touch the ground, {100 * mine:.0f} % do"
        )
    return f"up: {own.up}"


def default_path(study_file: str) -> Path:
    """Where the sheet goes unless somebody says otherwise: here, by the study's name."""
    return Path(f"{Path(study_file).stem}-models.png")


def write(study: Study, context: Context, path: Path) -> None:
    """Draw every model and write the sheet. An older sheet is replaced, and nothing else is.

    Raises InputError.
    """
    from PIL import Image, ImageDraw, PngImagePlugin

    if os.path.lexists(path) and not is_sheet(path):
        raise InputError(f"{path}: exists already and is no contact sheet; expected a new file")
    models = models_of(study)
    width = MARGIN + (len(VIEWS) + 1) * (TILE + MARGIN) + TEXT + MARGIN
    sheet = Image.new("RGB", (width, MARGIN + len(models) * (TILE + MARGIN + 20)), "white")
    draw = ImageDraw.Draw(sheet)
    font, bold = sheet_text.font(14), sheet_text.font(17)
    renderer = Renderer(context, (TILE, TILE))
    for row, own in enumerate(models):
        top = MARGIN + row * (TILE + MARGIN + 20)
        title = sheet_text.fitted(f"{own.name}   ({own.file})", bold, width - 2 * MARGIN)
        draw.text((MARGIN, top), title, fill="black", font=bold)
        for column, (said, picture) in enumerate(_pictures(own, renderer)):
            left = MARGIN + column * (TILE + MARGIN)
            sheet.paste(Image.fromarray(picture), (left, top + 20))
            draw.text((left + 4, top + TILE), said, fill=(90, 90, 90), font=font)
        left = MARGIN + (len(VIEWS) + 1) * (TILE + MARGIN)
        lines = _wrapped(described(own, facts_of(own), study))
        text = "\n".join(sheet_text.fitted(line, font, TEXT) for line in lines)
        draw.multiline_text((left, top + 22), text, fill="black", font=font, spacing=3)
    marked = PngImagePlugin.PngInfo()
    marked.add_text(*MARK)
    try:
        sheet.save(path, pnginfo=marked)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def is_sheet(path: Path) -> bool:
    """Whether it is a sheet that `check` drew: such a file may be replaced."""
    from PIL import Image

    try:
        with Image.open(path) as picture:
            return picture.info.get(MARK[0]) == MARK[1]
    except OSError:
        return False


def _pictures(own: OwnModel, renderer: Renderer) -> list[tuple[str, NDArray[np.uint8]]]:
    """What to call each picture of the model, and the picture: its sides, and lying on its side."""
    mesh = mesh_of(own)
    made = [(said, _seen(renderer, mesh, np.eye(4), *angles)) for said, angles in VIEWS.items()]
    other = "z" if own.up == "y" else "y"
    turn = rotation_x(np.radians(-90 if other == "z" else 90))
    return [*made, (f'if up = "{other}"', _seen(renderer, mesh, turn, *VIEWS["left front"]))]


def _seen(
    renderer: Renderer, mesh: Mesh, turn: NDArray[np.float64], yaw: float, pitch: float
) -> NDArray[np.uint8]:
    transform = turn @ scaling(1 / mesh.radius)
    center = transform[:3, :3] @ mesh.center
    y, p = np.radians(yaw), np.radians(pitch)
    # Its front is at −z, so that is where it is seen from at yaw 0; −40 shows its own left side.
    way = np.array([np.cos(p) * np.sin(y), np.sin(p), -np.cos(p) * np.cos(y)])
    camera = look_at(center + 3.6 * way, center, fov_y=np.radians(34), near=0.5, far=10.0)
    renderer.draw(Scene((Object(mesh, transform),), BACKGROUND), camera, Standard())
    return renderer.read().copy()


def _wrapped(lines: list[str], most: int = 44) -> list[str]:
    import textwrap

    return [part for line in lines for part in textwrap.wrap(line, most, subsequent_indent="  ")]
