"""How numbers are written: APA style, at a fixed precision for each kind of quantity."""

from __future__ import annotations

import math
from typing import SupportsFloat

from seethrough.analysis.stats.undefined import Undefined

MINUS = "−"
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def fixed(value: float, digits: int) -> str:
    """`digits` decimals, a real minus sign, no negative zero."""
    text = f"{value:.{digits}f}"
    if float(text) == 0:
        text = text.lstrip("-")
    return text.replace("-", MINUS)


def bounded(value: float, digits: int) -> str:
    """Quantities that cannot exceed 1 lose their leading zero (APA 7, 6.36)."""
    text = fixed(value, digits)
    return text.replace("0.", ".", 1) if abs(value) < 1 and not text.startswith("1") else text


def p_value(value: float) -> str:
    """Three decimals, `< .001` below; 1 only where it is 1, as that of an exact test can be.

    What three would show as .050 gets a fourth, to tell on which side of .05 it is.
    """
    if value == 1:
        return "1"
    if value >= 0.9995:
        return "> .999"
    if bounded(value, 3) == ".050":
        return bounded(value, 4)
    return "< .001" if value < 0.001 else bounded(value, 3)


def equals(shown: str) -> str:
    """`= ` before a shown number, nothing before one with a sign of its own (`< .001`)."""
    return "" if shown.startswith(("<", ">")) else "= "


def significant(value: float, digits: int = 3) -> str:
    """`digits` significant figures; very large and very small ones as powers of ten."""
    if value == 0:
        return "0"
    exponent = math.floor(math.log10(abs(value)))
    if exponent >= 5 or exponent < -3:
        return f"{fixed(value / 10.0**exponent, digits - 1)} × 10{str(exponent).translate(_RAISED)}"
    return fixed(value, max(0, digits - 1 - exponent))


def show(value: object, style: str) -> str:
    """`value` as `style` says: text, int, fixedN, boundN, p, sigN. Undefined shows its reason."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Undefined) or style == "text" or isinstance(value, str):
        return str(value)
    if not isinstance(value, SupportsFloat):
        raise TypeError(f"{value!r}: expected a number or text")
    number = float(value)
    if style == "int":
        return f"{number:.0f}".replace("-", MINUS)
    if style == "p":
        return p_value(number)
    kind, digits = style[:-1], int(style[-1])
    if kind == "fixed":
        return fixed(number, digits)
    return bounded(number, digits) if kind == "bound" else significant(number, digits)
