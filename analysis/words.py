"""How words are written, wherever they stand."""

from __future__ import annotations


def capitalised(words: str) -> str:
    """With a capital first letter, the others as they are."""
    return words[:1].upper() + words[1:]
