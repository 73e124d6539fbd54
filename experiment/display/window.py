"""A window that shows views and pages, and turns its events into ours."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from math import inf
from typing import TYPE_CHECKING

import moderngl
import pyglet

# Without this, importing pyglet.window opens a window, and fails where there is no display.
pyglet.options.shadow_window = False
from pyglet.window import key, mouse

from seethrough.experiment.display.clock import Clock
from seethrough.experiment.display.display import LEAVE, MEANT, DisplayLost, Leave
from seethrough.experiment.display.driver import describe, samples_for, window_context
from seethrough.experiment.display.event_time import EventTime
from seethrough.experiment.display.interrupt import check
from seethrough.experiment.display.refresh import rate_of
from seethrough.experiment.display.stage import Stage
from seethrough.experiment.display.system_window import (
    ON_X11,
    open_window,
    say_when_the_server_goes,
)
from seethrough.experiment.display.waiting import Waits
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.key_names import KEY_NAMES
from seethrough.experiment.pages.pages import Answers, Page
from seethrough.experiment.pages.texts import Texts
from seethrough.renderer.events import (
    Event,
    FocusChange,
    KeyPress,
    KeyRelease,
    PointerMove,
    PointerPress,
    PointerRelease,
    SecondPress,
    SecondRelease,
    Tick,
    Wheel,
)
from seethrough.tasks.kit.base import View

if TYPE_CHECKING:
    from seethrough.experiment.study.tables.study_tables import DisplayTable
    from seethrough.renderer.techniques.base import Parameters

FLIPS = 30  # that measure the refresh rate: half a second at 60 Hz
_KEYS = {getattr(key, theirs): ours for theirs, ours in KEY_NAMES.items()}

# What the driver's refusals are raised as, and the errors after which no picture can be trusted:
# GL_CONTEXT_LOST is newer than the version that moderngl names the errors of.
BROKEN = (moderngl.Error, pyglet.gl.GLException, pyglet.gl.ContextException)
GONE = ("GL_UNKNOWN_ERROR", "GL_OUT_OF_MEMORY")

WITHIN = "within the frame before its dispatch, each with its bound"


class Window(Waits):
    """Display and Input of a session. Raises InputError where no window can be opened."""

    def __init__(self, table: DisplayTable, texts: Texts, clock: Clock, title: str) -> None:
        self.clock = clock
        self._window = open_window(table, title)
        if ON_X11:
            say_when_the_server_goes()
        self.context = window_context()
        self.declared, self.measured = table.refresh, rate_of(self._bare_flips())  # Hz
        self.period = 1.0 / (self.measured or self.declared)
        self._pace = min(self.period, 1.0 / self.declared)  # a display that waits does the rest
        samples = samples_for(table.samples, self.context)
        self.stage = Stage(self.context, self._window.get_framebuffer_size(), texts, samples)
        self.technique: Parameters | None = None  # what the view shown last was drawn with
        self._when = self._window.event_time = EventTime(clock.now)
        self._window.compare_clocks()
        self._events: list[Event] = []
        self._down: set[str] = set()
        self._away: FocusChange | None = None  # how the focus was lost, while it is
        self._form: Form | None = None
        self._form_shown = inf  # when its first frame was
        self._closed = False
        self.flip_within = 0.0  # s: the last flip may have been shown so much earlier
        self._flipped = time.perf_counter()
        self._passed = self.period
        self._window.push_handlers(self)
        self.on_frame: Callable[[], None] = lambda: None

    # Display

    @property
    def size(self) -> tuple[int, int]:
        """(width, height) of the picture, in pixels."""
        return self.stage.size

    @property
    def aspect(self) -> float:
        """Width / height of the view."""
        return self.stage.aspect

    def show(self, view: View, technique: Parameters) -> float:
        """Draw a view and flip; the time of the flip."""
        self._window.set_exclusive_mouse(view.captured)
        self.technique = technique
        with self._graphics():
            self.stage.draw_view(view, technique, self.context.screen, self._passed)
        self.on_frame()
        return self._flip()

    def digest(self) -> str:
        """A digest of the picture shown last, without its HUD."""
        with self._graphics():
            return self.stage.digest()

    def progress(self, fraction: float) -> None:
        """Draw the progress line up to `fraction` from now on."""
        self.stage.done = fraction

    def describe(self) -> Mapping[str, str]:
        """Driver, size and refresh rate."""
        width, height = self.stage.size
        rate = self._window.screen.get_mode().rate if self._window.screen.get_mode() else None
        return {
            **describe(self.context),
            "size": f"{width}x{height}",
            "samples": str(self.stage.samples),
            "refresh_declared": f"{self.declared:g}",
            "refresh_measured": f"{self.measured:.2f}" if self.measured else "does not wait",
            "refresh_of_screen": str(rate or "unknown"),
            "window": "yes",
            "input_time": "X11 event time, 1 ms" if self._when.trusted else WITHIN,
            "focus_time": WITHIN,
        }

    # Input

    def begin_trial(self, task: str, training: bool) -> None:
        """Forget what was pressed before the trial, but for Esc and F1: they mean no task."""
        # A search for cyclic garbage can take longer than a frame: now, and then after the trial.
        gc.collect()
        gc.disable()
        self._window.compare_clocks()
        self._pump()
        self._events = [e for e in self._events if isinstance(e, KeyPress) and e.key in MEANT]
        if self._away is not None:  # lost on a page before
            self._events.append(self._away)

    def events(self, view: View) -> list[Event]:
        """What happened until now, in its order. Raises Leave when the window was closed.

        Events of a later moment that came in already are kept for the next time, so that time
        never runs back from one call to the next.
        """
        now = self._pump()
        if self._closed:
            raise Leave
        # Keys and pointer come from different queues of the system.
        self._events.sort(key=lambda e: e.time)
        happened = [e for e in self._events if e.time <= now]
        self._events = self._events[len(happened) :]
        return [*happened, Tick(now)]

    def ask(self, page: Page) -> Answers:
        """Show a page until it is answered; Esc asks whether to leave. Raises Leave."""
        self.prepare(page)
        self._window.set_exclusive_mouse(False)
        gc.enable()
        form = Form(page)
        self._turn_to(form)
        while not self._draw_page(form):
            if self._closed:
                raise Leave
            if page.name != "leave" and self._escape_pressed():
                self.confirm_leaving()
                self._turn_to(form)
        self._form = None
        self._events.clear()
        return form.answers

    def confirm_leaving(self) -> None:
        """Ask whether to leave. Raises Leave if so."""
        if self.ask(LEAVE)["button"] == "1":
            raise Leave

    def _turn_to(self, form: Form) -> None:
        """From its first frame on a page takes what is pressed; nothing from before."""
        self._form, self._form_shown = form, inf
        self._events.clear()
        # Keys that were down in the view before, and whose release went elsewhere, are up now;
        # what was pressed more than once on the page before waits there, one a frame.
        io = self.stage.interface.io
        io.clear_events_queue()
        io.clear_input_keys()
        io.clear_input_mouse()

    def left(self) -> bool:
        """Handle what came in; whether Esc was pressed or the window closed."""
        self._pump()
        return self._closed or self._escape_pressed()

    def point(self, at: tuple[float, float] | None) -> None:
        """Draw a pointer at a place in view units, for a simulated participant's hand."""
        self.stage.pointer = at

    def close(self) -> None:
        """Close the window."""
        gc.enable()
        self.stage.interface.close()
        self._window.remove_handlers(self)
        with suppress(*BROKEN):  # its context is lost: there is nothing left to give back
            self._window.close()

    def _draw_page(self, form: Form) -> bool:
        self._pump()
        with self._graphics():
            pressed = self.stage.draw_form(form, self.context.screen, self._passed)
        self.on_frame()
        self._form_shown = min(self._form_shown, self._flip())
        return pressed

    def _escape_pressed(self) -> bool:
        pressed = any(isinstance(e, KeyPress) and e.key == "escape" for e in self._events)
        self._events.clear()
        return pressed

    def _pump(self) -> float:
        """Dispatch what came in; the time before which nothing is left to come."""
        check()
        now = self.clock.now()
        self._window.switch_to()
        self._window.settle()
        self._window.dispatch_events()
        self._when.drained(now)
        return now

    @contextmanager
    def _graphics(self) -> Iterator[None]:
        """Raises DisplayLost where the driver refuses, or says that the context is no more."""
        try:
            yield
        except BROKEN as error:
            raise DisplayLost(str(error)) from error
        if (said := self.context.error) in GONE:
            raise DisplayLost(said)

    def _bare_flips(self) -> list[float]:
        """When flips with nothing drawn returned; the first ones may not wait, and do not count."""
        flips = []
        for _ in range(FLIPS):
            self._window.flip()
            flips.append(time.perf_counter())
        return flips[FLIPS // 6 :]

    def _flip(self) -> float:
        """Flip, and pace: a display without a vertical retrace returns from the flip at once.

        The time is that of the flip; what is left of the period is waited for after it.
        """
        began = self.clock.now()
        with self._graphics():
            self._window.flip()
            self._window.settle()  # where pictures are copied, this one was
        shown = self.clock.now()
        self.flip_within = shown - began
        early = self._flipped + self._pace - time.perf_counter()
        if early > 0:
            time.sleep(early)
        now = time.perf_counter()
        self._passed, self._flipped = now - self._flipped, now
        return shown

    def _blind(self) -> bool:
        """Whether the event came before anybody saw the page: meant for the one before it."""
        return self._form is not None and self._when.moment()[0] < self._form_shown

    def _note(self, kind: Callable[..., Event], *what: object) -> None:
        time, within = self._when.moment()
        self._events.append(kind(time, *what, within))

    # pyglet's events. Its pixels count from the lower left corner of the window.

    def _at(self, x: float, y: float) -> tuple[float, float]:
        return x / self._window.height, 1.0 - y / self._window.height

    def _io_pointer(self, x: float, y: float) -> None:
        ratio = self.stage.size[1] / self._window.height
        io = self.stage.interface.io
        io.add_mouse_pos_event(x * ratio, (self._window.height - y) * ratio)

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """The pointer moved, no button down."""
        self._moved(x, y, dx, dy, False)

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, _: int) -> None:
        """The pointer moved with a button down."""
        self._moved(x, y, dx, dy, bool(buttons & mouse.LEFT))

    def _moved(self, x: int, y: int, dx: int, dy: int, dragging: bool) -> None:
        self._io_pointer(x, y)
        (time, within), height = self._when.moment(), self._window.height
        turn = dx / height, -dy / height
        self._events.append(PointerMove(time, *self._at(x, y), *turn, dragging, within))

    def on_mouse_press(self, x: int, y: int, button: int, _: int) -> None:
        """A button went down."""
        if self._blind():
            return
        if button == mouse.LEFT:
            self._io_pointer(x, y)
            self.stage.interface.io.add_mouse_button_event(0, True)
            self._note(PointerPress, *self._at(x, y))
        elif button == mouse.RIGHT:
            self._note(SecondPress, *self._at(x, y))

    def on_mouse_release(self, x: int, y: int, button: int, _: int) -> None:
        """A button went up."""
        if button == mouse.LEFT:
            self._io_pointer(x, y)
            self.stage.interface.io.add_mouse_button_event(0, False)
            self._note(PointerRelease, *self._at(x, y))
        elif button == mouse.RIGHT:
            self._note(SecondRelease, *self._at(x, y))

    def on_mouse_scroll(self, x: int, y: int, _: float, dy: float) -> None:
        """The wheel turned: pages scroll, and some techniques take it."""
        if not self._blind():
            self.stage.interface.io.add_mouse_wheel_event(0, dy)
            self._note(Wheel, *self._at(x, y), dy)

    def on_key_press(self, symbol: int, _: int) -> bool:
        """A key went down. Handled: pyglet would close the window on Esc."""
        name = _KEYS.get(symbol)
        if name == "escape" or (name and not self._blind()):
            self.stage.interface.key(name, True)
            self._note(KeyPress, name)
            self._down.add(name)
        return pyglet.event.EVENT_HANDLED

    def on_key_release(self, symbol: int, _: int) -> None:
        """A key went up."""
        name = _KEYS.get(symbol)
        if name:
            self.stage.interface.key(name, False)
            self._note(KeyRelease, name)
            self._down.discard(name)

    def on_text(self, text: str) -> None:
        """Characters typed, for text fields."""
        if self._form is not None and not self._blind():
            # Enter and Tab arrive as keys already.
            printable = "".join(c for c in text if c.isprintable())
            self.stage.interface.io.add_input_characters_utf8(printable)

    def on_resize(self, width: int, height: int) -> bool:
        """The window changed its size. Handled: pyglet would set a viewport of its own."""
        if hasattr(self, "stage"):
            self.stage.resize(self._window.get_framebuffer_size())
        return pyglet.event.EVENT_HANDLED

    def on_activate(self) -> None:
        """The window has the desktop's focus."""
        self._away = None
        self._note(FocusChange, True)

    def on_deactivate(self) -> None:
        """Another window has the focus now; keys that were down come up unseen."""
        for name in sorted(self._down):
            self._note(KeyRelease, name)
        self._down.clear()
        self.stage.interface.io.clear_input_keys()
        time, within = self._when.moment()
        self._away = FocusChange(time, False, within)
        self._events.append(self._away)

    def on_close(self) -> bool:
        """The desktop closes the window: the session saves and leaves. Handled by us."""
        self._closed = True
        return pyglet.event.EVENT_HANDLED
