"""`seethrough view`: look at a scene of translucent polygons, ordered by a method."""

from __future__ import annotations

import argparse
from pathlib import Path

from seethrough.experiment.errors import InputError
from seethrough.renderer.models.translucent.scenes import SCENES, scene
from seethrough.renderer.polygons.fragments import TooManyPieces
from seethrough.renderer.polygons.methods import METHODS, prepare

HELP = "look at a scene of translucent polygons, ordered by a method"
SIZE = (960, 720)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("scene", choices=tuple(SCENES), metavar="SCENE", help=", ".join(SCENES))
    parser.add_argument(
        "--order", choices=tuple(METHODS), default="bsp", metavar="METHOD", help=", ".join(METHODS)
    )
    parser.add_argument(
        "--most-pieces", type=int, metavar="N", help="into which an order may cut the polygons"
    )
    parser.add_argument(
        "--picture", type=Path, metavar="FILE", help="write the first picture instead of a window"
    )


def run(args: argparse.Namespace) -> int:
    """Open the viewer, or write its first picture."""
    made = scene(args.scene)
    try:
        prepared = prepare(args.order, made.polygons, args.most_pieces)
    except TooManyPieces as error:
        raise InputError(f"{args.scene}: {error}") from None
    if prepared.stats.dense and args.picture is None:
        print(f"{args.scene}: {prepared.stats.dense}")
    if args.picture is None:
        from seethrough.experiment.display.viewer_window import show

        show(made, prepared, args.order, SIZE)
        return 0
    if not args.picture.parent.is_dir():
        raise InputError(f"--picture = {args.picture}: expected an existing folder")
    import numpy as np
    from PIL import Image

    from seethrough.experiment.display.viewer import Viewer, ViewState
    from seethrough.renderer.gpu.device.context import standalone

    viewer = Viewer(standalone(), SIZE, made, prepared)
    picture = viewer.picture(ViewState())
    Image.fromarray(np.round(picture[..., :3].clip(0, 1) * 255).astype(np.uint8)).save(args.picture)
    print("\n".join(viewer.summary(args.order)))
    return 0
