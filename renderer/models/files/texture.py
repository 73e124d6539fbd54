"""Pictures on surfaces: decoded to linear light, looked up as a viewer's sampler does."""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from seethrough.renderer.arrays import Floats32
from seethrough.renderer.models.files.source import Refused

REPEAT, CLAMP, MIRROR = 10497, 33071, 33648  # as glTF numbers them
MOST_PIXELS = 2**26  # of a picture that is read at all
MOST_TEXELS = 2**20  # of what is looked up: more than a model's vertices can carry anyway
_SRGB = np.arange(256) / 255
_LIGHT = np.where(_SRGB <= 0.04045, _SRGB / 12.92, ((_SRGB + 0.055) / 1.055) ** 2.4)


@dataclass(frozen=True, eq=False)
class Texture:
    """levels: (h, w, 4) float32 linear RGBA, row 0 at v = 0, each half the size of the one before;
    `wrap` along u and v; `nearest`: texels have hard edges."""

    levels: tuple[NDArray[np.float32], ...]
    wrap: tuple[int, int] = (REPEAT, REPEAT)
    nearest: bool = False

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) in texels."""
        return self.levels[0].shape[1], self.levels[0].shape[0]

    def sample(self, uv: NDArray[np.float64], level: int = 0) -> NDArray[np.float64]:
        """(k, 4) at uv (k, 2): of the four nearest texels, or of the nearest one alone."""
        picture = self.levels[min(level, len(self.levels) - 1)]
        height, width = picture.shape[:2]
        x, y = uv[:, 0] * width, uv[:, 1] * height
        if self.nearest and level == 0:
            return picture[
                _wrapped(np.floor(y), height, self.wrap[1]),
                _wrapped(np.floor(x), width, self.wrap[0]),
            ].astype(float)
        x, y = x - 0.5, y - 0.5
        left, top = np.floor(x), np.floor(y)
        a, b = (x - left)[:, None], (y - top)[:, None]
        columns = [_wrapped(left + i, width, self.wrap[0]) for i in (0, 1)]
        rows = [_wrapped(top + i, height, self.wrap[1]) for i in (0, 1)]
        upper = picture[rows[0], columns[0]] * (1 - a) + picture[rows[0], columns[1]] * a
        lower = picture[rows[1], columns[0]] * (1 - a) + picture[rows[1], columns[1]] * a
        return upper * (1 - b) + lower * b


def _wrapped(index: NDArray[np.float64], count: int, way: int) -> NDArray[np.int64]:
    """Texels in [0, count) of whole numbers that may lie beyond."""
    if way == CLAMP:
        return np.clip(index, 0, count - 1).astype(np.int64)
    if way == MIRROR:
        along = np.mod(index, 2 * count)
        return np.minimum(along, 2 * count - 1 - along).astype(np.int64)
    return np.minimum(np.mod(index, count), count - 1).astype(np.int64)


def decoded(
    data: bytes,
    what: str,
    wrap: tuple[int, int] = (REPEAT, REPEAT),
    nearest: bool = False,
    upward: bool = False,
) -> Texture:
    """A PNG, JPEG or other picture as a texture.

    `upward`: v = 0 is its lower edge and its alpha means nothing (OBJ, PLY).

    Raises Refused for what cannot be read.
    """
    pixels = _pixels(data, what)
    if upward:
        pixels = np.dstack([pixels[::-1, :, :3], np.full(pixels.shape[:2], 255, np.uint8)])
    first: Floats32 = np.empty(pixels.shape, np.float32)
    first[..., :3] = _LIGHT[pixels[..., :3]]
    first[..., 3] = pixels[..., 3] / 255
    while first.shape[0] * first.shape[1] > MOST_TEXELS:
        first = _halved(first)
    levels = [first]
    while max(levels[-1].shape[:2]) > 1:
        levels.append(_halved(levels[-1]))
    return Texture(tuple(levels), wrap, nearest)


def _pixels(data: bytes, what: str) -> NDArray[np.uint8]:
    """(h, w, 4) of a picture's bytes."""
    from PIL import Image, UnidentifiedImageError

    if data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n":
        raise Refused(f"{what}: is compressed (KTX2): save it as PNG or JPEG")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of size, which is checked below, and odd entries
            picture = Image.open(io.BytesIO(data))
        with picture, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            width, height = picture.size
            if width * height > MOST_PIXELS:
                raise Refused(f"{what}: {width} × {height} pixels: expected {MOST_PIXELS} at most")
            if picture.mode.startswith("I"):  # 16 bits a pixel, which converting would cut
                grey = np.asarray(picture, float) / 65535
                rgba = np.stack([grey, grey, grey, np.ones_like(grey)], axis=-1)
                return np.round(255 * np.clip(rgba, 0, 1)).astype(np.uint8)
            return np.asarray(picture.convert("RGBA"))
    except UnidentifiedImageError:
        raise Refused(f"{what}: expected a picture (PNG or JPEG), it is none") from None
    except (OSError, SyntaxError, ValueError, EOFError, Image.DecompressionBombError) as error:
        if isinstance(error, Refused):
            raise
        reason = " ".join(str(error).split())[:100]
        raise Refused(f"{what}: expected a picture, it cannot be read: {reason}") from None


def _halved(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    """Half as wide and high: means of four texels, an odd last row or column with its neighbour."""
    for axis in (0, 1):
        length = picture.shape[axis]
        if length > 1:
            starts = np.arange(0, length - 1, 2)
            sums: Floats32 = np.add.reduceat(picture, starts, axis=axis, dtype=np.float32)
            counts = np.diff(np.append(starts, length)).astype(np.float32)
            picture = sums / counts.reshape((-1, 1, 1) if axis == 0 else (1, -1, 1))
    return picture
