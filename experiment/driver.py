"""Names of the graphics driver, for records."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


def describe(context: Any) -> Mapping[str, str]:
    """Vendor, renderer and version of a context's OpenGL."""
    info = context.info
    return {
        "vendor": info["GL_VENDOR"],
        "renderer": info["GL_RENDERER"],
        "opengl": info["GL_VERSION"],
    }
