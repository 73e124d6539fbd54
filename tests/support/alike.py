"""Two trees of numbers, texts and lists, and where they are not alike."""

from __future__ import annotations

import pytest


def differences(found, known, where=""):
    """Paths at which two trees of numbers, texts and lists are not alike."""
    if isinstance(known, dict) and isinstance(found, dict):
        keys = set(known) ^ set(found)
        parts = [differences(found[k], known[k], f"{where}.{k}") for k in set(known) & set(found)]
    elif isinstance(known, list) and isinstance(found, list) and len(known) == len(found):
        keys = ()
        parts = [differences(a, b, f"{where}[{n}]")
                 for n, (a, b) in enumerate(zip(found, known, strict=True))]  # fmt: skip
    elif isinstance(known, float) and isinstance(found, int | float):
        # Nine digits are written down; libraries of mathematics differ in the last, and what
        # cancels in a sum of thousands leaves their rounding.
        same = found == pytest.approx(known, rel=1e-6, abs=1e-6)
        return [] if same else [f"{where}: {found} for {known}"]
    else:
        return [] if found == known else [f"{where}: {found} for {known}"]
    return [f"{where}.{k}" for k in keys] + [line for part in parts for line in part]
