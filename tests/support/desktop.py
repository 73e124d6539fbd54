"""A screen of one's own (Xvfb) and a hand on its mouse and keyboard (xdotool)."""

import os
import subprocess
import sys
import time
from pathlib import Path


class Desktop:
    """An X server on a free display number; a context manager that leaves no process behind."""

    def __init__(self, width=1024, height=768):
        self.size = f"{width}x{height}x24"
        self.env = dict(os.environ)

    def __enter__(self):
        read, write = os.pipe()
        # Without -noreset the server starts again when its last client ends, and refuses the next
        # one in the meantime: a killed session is such a last client.
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", self.size]
        command += ["-nolisten", "tcp", "-noreset"]
        self.server = subprocess.Popen(
            command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        os.close(write)
        with os.fdopen(read) as numbers:
            self.env["DISPLAY"] = f":{numbers.readline().strip()}"
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait(10)

    def do(self, *words):
        """One xdotool command."""
        subprocess.run(["xdotool", *map(str, words)], env=self.env, check=True, timeout=20)

    def keys(self, *names, pause=0.06):
        """Press and release keys one after the other."""
        for name in names:
            self.do("key", name)
            time.sleep(pause)

    def close_window(self, title):
        """What a window manager does when its close button is pressed: WM_DELETE_WINDOW."""
        script = (
            "import ctypes, sys\n"
            "from ctypes.util import find_library\n"
            "x = ctypes.CDLL(find_library('X11') or 'libX11.so.6')\n"
            "x.XOpenDisplay.restype = ctypes.c_void_p\n"
            "x.XInternAtom.restype = ctypes.c_ulong\n"
            "d = ctypes.c_void_p(x.XOpenDisplay(sys.argv[1].encode()))\n"
            "class E(ctypes.Structure):\n"
            "    _fields_ = [('type', ctypes.c_int), ('serial', ctypes.c_ulong),\n"
            "        ('send', ctypes.c_int), ('display', ctypes.c_void_p),\n"
            "        ('window', ctypes.c_ulong), ('message', ctypes.c_ulong),\n"
            "        ('format', ctypes.c_int), ('data', ctypes.c_long * 5),\n"
            "        ('pad', ctypes.c_long * 24)]\n"
            "atom = lambda n: x.XInternAtom(d, n, 0)\n"
            "w = int(sys.argv[2])\n"
            "e = E(33, 0, 1, d, w, atom(b'WM_PROTOCOLS'), 32)\n"
            "e.data[0] = atom(b'WM_DELETE_WINDOW')\n"
            "x.XSendEvent(d, ctypes.c_ulong(w), 0, ctypes.c_long(0), ctypes.byref(e))\n"
            "x.XSync(d, 0)\n"
        )
        search = ["xdotool", "search", "--onlyvisible", "--name", title]
        found = subprocess.run(search, env=self.env, capture_output=True, text=True, check=True)
        words = [sys.executable, "-c", script, self.env["DISPLAY"], found.stdout.split()[0]]
        subprocess.run(words, check=True, timeout=30)

    def screenshot(self, path):
        """The whole screen as a PNG."""
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        code = (
            "import sys\nfrom PIL import ImageGrab\n"
            "ImageGrab.grab(xdisplay=sys.argv[1]).save(sys.argv[2])"
        )
        words = [sys.executable, "-c", code, self.env["DISPLAY"], str(path)]
        subprocess.run(words, check=True, timeout=30)


class Program:
    """`seethrough …` on a desktop; what it says is read from its log as it comes."""

    def __init__(self, desktop, log, *words, start=(sys.executable, "-m", "seethrough")):
        self.log = Path(log)
        self._file = open(self.log, "w", encoding="utf-8")
        command = [*map(str, start), *map(str, words)]
        self.process = subprocess.Popen(
            command, env=desktop.env, stdout=self._file, stderr=self._file, stdin=subprocess.DEVNULL
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Kill it if it still runs."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(10)
        self._file.close()

    def said(self):
        """What it has written so far."""
        return self.log.read_text(encoding="utf-8")

    def trials(self):
        """How many trials it has reported."""
        return sum(line.startswith("trial ") for line in self.said().splitlines())

    def running(self):
        """Whether it still runs."""
        return self.process.poll() is None


def wait_until(condition, seconds, what):
    """Poll until `condition()`; AssertionError names what did not come."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, f"{what} did not come within {seconds} s"
        time.sleep(0.05)
