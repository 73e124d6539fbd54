"""The viewer's window (`seethrough view`): beside window.py the only pyglet import."""

from __future__ import annotations

import pyglet

pyglet.options.shadow_window = False
from pyglet.window import key, mouse

from seethrough.experiment.display.driver import no_window, window_context
from seethrough.experiment.display.viewer import Viewer, ViewState
from seethrough.renderer.models.translucent.scenes import TranslucentScene
from seethrough.renderer.polygons.prepared import Prepared

KEYS = {
    key.T: "t", key.O: "o", key.L: "l", key.P: "p", key.LEFT: "left", key.RIGHT: "right",
    key.UP: "up", key.DOWN: "down", key.PAGEUP: "pageup", key.PAGEDOWN: "pagedown",
}  # fmt: skip
DRAG = 0.008  # radians a pixel


def show(scene: TranslucentScene, prepared: Prepared, method: str, size: tuple[int, int]) -> None:
    """Open a window and run until it is closed (Esc). Raises InputError without a display."""
    try:
        window = pyglet.window.Window(*size, caption=f"{scene.name} – {method}", vsync=True)
    except Exception as error:  # pyglet raises a different class on each platform
        raise no_window(error, "--picture FILE writes the first picture") from error
    context = window_context()
    viewer = Viewer(context, window.get_framebuffer_size(), scene, prepared)
    label = pyglet.text.Label(
        "\n".join(
            [*viewer.summary(method), "t texturing  o opaque  l lines  p polygons  arrows, mouse"]
        ),
        x=10,
        y=size[1] - 18,
        multiline=True,
        width=size[0] - 20,
        color=(20, 20, 20, 255),
        font_size=11,
    )
    state = ViewState()

    def on_key_press(symbol: int, _modifiers: int) -> None:
        nonlocal state
        if symbol in KEYS:
            state = state.pressed(KEYS[symbol])
        elif symbol == key.ESCAPE:
            window.close()

    def on_mouse_drag(_x: int, _y: int, dx: int, dy: int, buttons: int, _modifiers: int) -> None:
        nonlocal state
        if buttons & mouse.LEFT:
            state = state.dragged(-DRAG * dx, -DRAG * dy)

    def on_mouse_scroll(_x: int, _y: int, _dx: float, dy: float) -> None:
        nonlocal state
        state = state.moved(0.9**dy)

    def on_draw() -> None:
        viewer.draw(state)
        viewer.present(context.screen)
        label.draw()

    window.set_handlers(on_key_press, on_mouse_drag, on_mouse_scroll, on_draw)
    pyglet.app.run()
