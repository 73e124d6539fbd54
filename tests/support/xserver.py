"""Keys and pixels of an X server at moments that are known: Xlib and XTest by ctypes.

A program such as xdotool takes milliseconds to start; here each call is bracketed by two readings
of the monotonic clock that is also the window's (`RealClock`) and the X server's.
"""

import ctypes
import time
from ctypes.util import find_library

Z_PIXMAP, ALL_PLANES = 2, ctypes.c_ulong(-1)


class _Image(ctypes.Structure):
    """The beginning of an XImage."""

    _fields_ = [("size", ctypes.c_int * 4), ("data", ctypes.POINTER(ctypes.c_ubyte))]


class XServer:
    """A connection of one's own to a display. All coordinates are pixels of the whole screen."""

    def __init__(self, name):
        self._x = ctypes.CDLL(find_library("X11") or "libX11.so.6")
        self._test = ctypes.CDLL(find_library("Xtst") or "libXtst.so.6")
        self._x.XOpenDisplay.restype = self._x.XGetImage.restype = ctypes.c_void_p
        self._x.XDefaultRootWindow.restype = self._x.XStringToKeysym.restype = ctypes.c_ulong
        opened = self._x.XOpenDisplay(name.encode())
        assert opened, f"no display {name}"
        self._display = ctypes.c_void_p(opened)
        self._root = ctypes.c_ulong(self._x.XDefaultRootWindow(self._display))

    def close(self):
        """End the connection."""
        self._x.XCloseDisplay(self._display)

    def key(self, name):
        """Press and release a key; (before, after) of its press in s, monotonic."""
        symbol = ctypes.c_ulong(self._x.XStringToKeysym(name.encode()))
        code = self._x.XKeysymToKeycode(self._display, symbol)
        before = time.monotonic()
        self._fake(code, 1)
        after = time.monotonic()
        self._fake(code, 0)
        return before, after

    def move(self, x, y):
        """The pointer to a pixel; (before, after) in s, monotonic."""
        before = time.monotonic()
        self._test.XTestFakeMotionEvent(self._display, -1, int(x), int(y), ctypes.c_ulong(0))
        self._x.XSync(self._display, 0)
        return before, time.monotonic()

    def click(self):
        """Press and release the left button; (before, after) of its press in s, monotonic."""
        before = time.monotonic()
        self._test.XTestFakeButtonEvent(self._display, 1, 1, ctypes.c_ulong(0))
        self._x.XSync(self._display, 0)
        after = time.monotonic()
        self._test.XTestFakeButtonEvent(self._display, 1, 0, ctypes.c_ulong(0))
        self._x.XSync(self._display, 0)
        return before, after

    def part(self, x, y, width, height):
        """The bytes of a rectangle of the screen, four a pixel."""
        words = (x, y, width, height, ALL_PLANES, Z_PIXMAP)
        image = ctypes.c_void_p(self._x.XGetImage(self._display, self._root, *words))
        data = ctypes.cast(image, ctypes.POINTER(_Image)).contents.data
        found = ctypes.string_at(data, 4 * width * height)
        self._x.XDestroyImage(image)
        return found

    def _fake(self, code, down):
        self._test.XTestFakeKeyEvent(self._display, code, down, ctypes.c_ulong(0))
        self._x.XSync(self._display, 0)  # returns when the server has made the event

    def focus(self, window):
        """Give a window, by its number, the keyboard's focus; (before, after) in s, monotonic."""
        before = time.monotonic()
        self._x.XSetInputFocus(self._display, ctypes.c_ulong(window), 1, ctypes.c_ulong(0))
        self._x.XSync(self._display, 0)
        return before, time.monotonic()

    def pixel(self, x, y):
        """The bytes of a pixel: blue, green, red."""
        words = (x, y, 1, 1, ALL_PLANES, Z_PIXMAP)
        image = ctypes.c_void_p(self._x.XGetImage(self._display, self._root, *words))
        found = bytes(ctypes.cast(image, ctypes.POINTER(_Image)).contents.data[:3])
        self._x.XDestroyImage(image)
        return found

    def seen(self, x, y, wanted, seconds):
        """Wait until `wanted(pixel)`; (earliest, latest) moment of the change in s, monotonic."""
        end, earliest = time.monotonic() + seconds, -float("inf")
        while True:
            before = time.monotonic()
            if wanted(self.pixel(x, y)):
                return earliest, time.monotonic()
            earliest = before
            assert before < end, f"nothing changed within {seconds} s"
