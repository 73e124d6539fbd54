"""A real Chromium for the tests of pages, spoken to by the WebDriver protocol (W3C) itself.

Forty lines of HTTP do what is needed here: no further library between the test and the browser.
"""

from __future__ import annotations

import json
import os
import shutil
import socket
import subprocess
import time
import urllib.error
import urllib.request
from pathlib import Path
from types import TracebackType
from typing import Any

SECONDS = 120


class Browser:
    """A headless Chromium; use as a context."""

    def __init__(self, width: int = 1200, height: int = 900) -> None:
        driver, chromium = shutil.which("chromedriver"), shutil.which("chromium")
        if not driver or not chromium:
            raise RuntimeError(
                "chromium and chromedriver are needed: see tests/system-packages.txt"
            )
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        self._process = subprocess.Popen(
            [driver, f"--port={port}"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self._base = f"http://127.0.0.1:{port}"
        self._wait()
        root = ["--no-sandbox"] if os.geteuid() == 0 else []
        words = ["--headless=new", "--disable-gpu", "--disable-dev-shm-usage", *root]
        options = {
            "binary": chromium,
            "args": [*words, f"--window-size={width},{height}"],
        }
        wanted = {
            "goog:chromeOptions": options,
            "timeouts": {"script": 1000 * SECONDS},
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
        }
        reply = self._call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self._base += f"/session/{reply['sessionId']}"

    def _wait(self) -> None:
        end = time.monotonic() + SECONDS
        while True:
            try:
                self._call("GET", "/status")
                return
            except (urllib.error.URLError, ConnectionError):
                if time.monotonic() > end:
                    raise
                time.sleep(0.05)

    def _call(self, method: str, path: str, body: Any = None) -> Any:
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self._base + path, data, method=method)
        request.add_header("Content-Type", "application/json")
        try:
            with urllib.request.urlopen(request, timeout=SECONDS) as reply:
                return json.load(reply)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(json.load(error)["value"]["message"]) from None

    def open(self, page: Path) -> None:
        """Load a file."""
        self._call("POST", "/url", {"url": page.resolve().as_uri()})

    def run(self, script: str, *words: Any) -> Any:
        """Run JavaScript; `return` gives a value back."""
        return self._call("POST", "/execute/sync", {"script": script, "args": list(words)})

    def run_async(self, script: str, *words: Any) -> Any:
        """Run JavaScript that calls its last argument with the answer."""
        return self._call("POST", "/execute/async", {"script": script, "args": list(words)})

    def log(self, kind: str) -> list[dict[str, Any]]:
        """Entries of the console (`browser`) or the network (`performance`) since the last call."""
        return self._call("POST", "/se/log", {"type": kind})

    def point(self, x: float, y: float) -> None:
        """Move the mouse to a place in the window."""
        move = {"type": "pointerMove", "x": round(x), "y": round(y), "duration": 0}
        source = {"type": "pointer", "id": "mouse", "actions": [move]}
        self._call("POST", "/actions", {"actions": [source]})

    def press(self, key: str) -> None:
        """Press and release a key (WebDriver's code, e.g. U+E004 for Tab)."""
        keys = [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
        self._call(
            "POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": keys}]}
        )

    def devtools(self, command: str, **parameters: Any) -> Any:
        """A DevTools command, e.g. to choose the colour scheme."""
        return self._call("POST", "/goog/cdp/execute", {"cmd": command, "params": parameters})

    def __enter__(self) -> Browser:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self._call("DELETE", "")
        finally:
            self._process.terminate()
            self._process.wait(SECONDS)
