"""The keys of renderer/events.py, by pyglet's names of them; what is not listed is not heard."""

from __future__ import annotations

from string import ascii_lowercase, digits

KEY_NAMES = {
    **{name.upper(): name for name in ("left", "right", "up", "down", "space", "backspace")},
    **{name.upper(): name for name in ("delete", "escape", "tab", "f1", "f2", "home", "end")},
    **{name.upper(): name for name in ("pageup", "pagedown")},
    **dict.fromkeys(("RETURN", "ENTER", "NUM_ENTER"), "enter"),
    **dict.fromkeys(("LSHIFT", "RSHIFT"), "shift"),
    **{f"_{digit}": digit for digit in digits},
    **{f"NUM_{digit}": digit for digit in digits},
    **{letter.upper(): letter for letter in ascii_lowercase},
}
