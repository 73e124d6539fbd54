"""The system's window under ours: opened, its events stamped, its clock compared with ours.

With window.py and the viewer's the only pyglet import.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from ctypes import byref, c_ubyte
from typing import TYPE_CHECKING

import pyglet

from seethrough.experiment.display.event_time import XEvent

# Without this, importing pyglet.window opens a window, and fails where there is no display.
pyglet.options.shadow_window = False
import pyglet.window

from seethrough.experiment.display.driver import no_window
from seethrough.experiment.display.event_time import EventTime, x11_stamp

if TYPE_CHECKING:
    from seethrough.experiment.study.tables.study_tables import DisplayTable


ON_X11 = hasattr(pyglet.window.Window, "dispatch_platform_event")
ASKED, PROMPT = 5, 0.02  # how often the server is asked the time until it says so within so many s


class SystemWindow(pyglet.window.Window):  # type: ignore[misc]  # pyglet picks it as it runs
    """Keeps the system's stamp of the event that is being dispatched, where the system has one."""

    event_time: EventTime | None = None

    def dispatch_platform_event(self, event: XEvent) -> None:
        """X11 only: keys come this way."""
        self._stamped(super().dispatch_platform_event, event, "window")

    def dispatch_platform_event_view(self, event: XEvent) -> None:
        """X11 only: the pointer's events come this way."""
        self._stamped(super().dispatch_platform_event_view, event, "view")

    def _stamped(self, dispatch: Callable[[object], None], event: XEvent, queue: str) -> None:
        if self.event_time is None:
            return dispatch(event)
        self.event_time.stamp, self.event_time.queue = x11_stamp(event), queue
        try:
            return dispatch(event)
        finally:
            self.event_time.stamp = None

    def settle(self) -> None:
        """What the server has made of events so far can be dispatched when this returns."""
        if ON_X11:
            from pyglet.libs.x11 import xlib

            xlib.XSync(self._x_display, 0)

    def compare_clocks(self) -> None:
        """Find out whether the server's stamps are of the clock that we read."""
        if not ON_X11 or self.event_time is None:
            return
        for _ in range(ASKED):
            before = time.monotonic()
            stamp = self._server_time()
            after = time.monotonic()
            if after - before < PROMPT:
                break
        self.event_time.agrees(stamp, before, after)

    def _server_time(self) -> int | None:
        """ms; a property that is changed by nothing makes an event with the server's stamp."""
        from pyglet.libs.x11 import xlib

        name = xlib.XInternAtom(self._x_display, b"_SEETHROUGH_TIME", 0)
        kind = xlib.XInternAtom(self._x_display, b"STRING", 0)
        event, none = xlib.XEvent(), (c_ubyte * 1)()
        words = (self._x_display, self._window, xlib.PropertyNotify, byref(event))
        while xlib.XCheckTypedWindowEvent(*words):  # of earlier changes: nobody else reads them
            pass
        xlib.XChangeProperty(
            self._x_display, self._window, name, kind, 8, xlib.PropModeAppend, none, 0
        )
        xlib.XSync(self._x_display, 0)
        stamp = None
        while xlib.XCheckTypedWindowEvent(*words):
            if event.xproperty.atom == name:
                stamp = int(event.xproperty.time)
        return stamp


def open_window(table: DisplayTable, title: str) -> SystemWindow:
    """A window as the study wants it. Raises InputError where none can be opened."""
    config = pyglet.gl.Config(  # type: ignore[abstract]  # its __new__ makes the platform's
        double_buffer=True, major_version=3, minor_version=3, forward_compatible=True
    )
    # With sizes given, a screen is put into the mode that is nearest to them, if it can be.
    size = (None, None) if table.fullscreen else (table.width, table.height)
    try:
        return SystemWindow(
            *size, title, fullscreen=table.fullscreen, vsync=True,
            resizable=not table.fullscreen, config=config,
        )  # fmt: skip
    except Exception as error:  # pyglet raises a different class on each platform
        raise no_window(error) from error


_kept_handlers: list[object] = []  # Xlib does not keep them


def say_when_the_server_goes() -> None:
    """Xlib ends the program when its server does: with one line of ours instead of its own."""
    from pyglet.libs.x11 import xlib

    def end(_: object) -> int:
        line = "seethrough: display: the desktop went away; every completed trial is saved"
        print(line, file=sys.stderr, flush=True)
        os._exit(2)

    _kept_handlers.append(xlib.XIOErrorHandler(end))
    xlib.XSetIOErrorHandler(_kept_handlers[-1])


def available() -> bool:
    """Whether there is a desktop to open a window on."""
    try:
        pyglet.display.get_display()
    except Exception:  # a different class on each platform; the answer is the point
        return False
    return True
