"""The page as PDF, printed by a Chromium that is installed already."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from seethrough.analysis.errors import DataError

NAMES = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
)
PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Chromium.app/Contents/MacOS/Chromium",
    r"C:\Program Files\Google\Chrome\Application\chrome.exe",
    r"C:\Program Files (x86)\Microsoft\Edge\Application\msedge.exe",
)
SECONDS = 120


def find_browser() -> str:
    """A Chromium's path. Raises DataError, with what to do, if there is none."""
    for name in NAMES:
        if found := shutil.which(name):
            return found
    for place in PLACES:
        if Path(place).is_file():
            return place
    raise DataError(
        "--format = pdf: expected Chromium, Chrome or Edge on this machine, none was found: "
        "install one, or print report.html from any browser"
    )


def print_pdf(browser: str, page: Path, pdf: Path) -> None:
    """Print `page`. Raises DataError if the browser fails."""
    # browsers refuse their sandbox to root, which is who runs in a container
    root = ["--no-sandbox"] if sys.platform != "win32" and os.geteuid() == 0 else []
    with tempfile.TemporaryDirectory() as profile:
        words = [
            browser,
            "--headless",
            "--disable-gpu",
            *root,
            f"--user-data-dir={profile}",
            "--no-pdf-header-footer",
            f"--print-to-pdf={pdf.resolve()}",
            page.resolve().as_uri(),
        ]
        try:
            done = subprocess.run(words, capture_output=True, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            raise DataError(f"{browser}: did not print within {SECONDS} s") from None
    if done.returncode != 0 or not pdf.is_file():
        said = done.stderr.decode(errors="replace").strip().splitlines()
        raise DataError(f"{browser}: could not print: {said[-1] if said else 'no message'}")
