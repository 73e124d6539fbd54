"""Turning, walking or stepping on until the part can be made out, then clicking it."""

from __future__ import annotations

from seethrough.tasks.kit.skills.finding import TILTS, find_and_click
from seethrough.tasks.kit.skills.strategy import Strategy

STRATEGY = Strategy(find_and_click, {"slips": "the click may fall beside it"}, heights=TILTS)
