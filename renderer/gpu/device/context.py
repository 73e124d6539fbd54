"""An OpenGL context without a window."""

from __future__ import annotations

import sys

import moderngl

REQUIRED = 330


def standalone(require: int = REQUIRED) -> moderngl.Context:
    """A context of its own: EGL on Linux (no display needed), the platform's way elsewhere.

    Raises RuntimeError, in one line, where there is no OpenGL of the version asked for.
    """
    ways: list[dict[str, str]] = [{}]
    if sys.platform.startswith("linux"):
        # Machines without the development packages have the numbered names only.
        numbered = {"backend": "egl", "libgl": "libGL.so.1", "libegl": "libEGL.so.1"}
        ways = [{"backend": "egl"}, numbered, {}]
    problems = []
    for way in ways:
        try:
            return moderngl.create_context(
                standalone=True,
                require=require,
                **way,  # type: ignore[arg-type]  # moderngl's types want a dict for each
            )
        except Exception as error:  # glcontext raises bare Exception
            problems.append(str(error).strip().splitlines()[0] if str(error) else repr(error))
    raise RuntimeError(
        f"OpenGL {require // 100}.{require // 10 % 10}: not available ({problems[0]}), expected a "
        "graphics driver; without one, install Mesa (Debian: libegl1 libgl1 libgl1-mesa-dri)"
    )
