"""Ordinary depth-buffered rendering: what the paper compares dynamic transparency with."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Standard:
    """Opaque objects and a depth buffer. It has no parameters."""
