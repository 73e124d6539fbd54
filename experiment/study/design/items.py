"""Items: a scene and what is asked in it, where scenes are the same for everybody.

A person's K cells that share a task meet K sets of items, each set in one of them; from slot to
slot the sets move on. Over K × rows slots each set stands in each cell, and in each row of the
design, equally often, and nobody meets an item twice.
"""

from __future__ import annotations

LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def rotation(row: int, passes: int, sets: int) -> int:
    """How far the sets have moved, in a slot at `row` of the conditions' orders after so many
    passes through them.

    Within K passes every row meets every rotation once. The other terms keep the rotation apart
    from the order of conditions and from that of tasks: with 2 × 2 conditions and two tasks 16
    slots cross set, task order and row completely.
    """
    return (row + row // 2 + passes + passes // sets) % sets


def letters(number: int) -> str:
    """A set's name: A … Z, AA, AB, …"""
    name = ""
    number += 1
    while number:
        number, rest = divmod(number - 1, len(LETTERS))
        name = LETTERS[rest] + name
    return name
