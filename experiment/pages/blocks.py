"""Ready-made questionnaire pages. Sources: ratings 004 §VI-G; NASA-TLX raw (Hart & Staveland 1988,
public domain); SUS (Brooke 1996, free to use with its name)."""

from __future__ import annotations

from seethrough.experiment.pages.pages import Choice, Page, Scale, TextField

RATINGS = ("efficiency", "ease", "enjoy")
TLX = ("mental", "physical", "temporal", "performance", "effort", "frustration")
SUS_ITEMS = 10

Levels = tuple[tuple[str, str], ...]  # factor and level of what a page is about


def ratings(title: str, levels: Levels) -> Page:
    """Efficiency, ease and enjoyment at some levels, 0–4."""
    scales = tuple(Scale(item, f"rating.{item}", "rating.low", "rating.high") for item in RATINGS)
    return Page(_name("rating", levels), title, scales, levels=levels)


def comparison(options: tuple[str, ...], title: str, depth: bool, levels: Levels) -> Page:
    """Which the participant would rather work with; self-reported depth perception, 0–4."""
    scale = Scale("depth_self_report", "comparison.depth", "rating.low", "rating.high")
    choice = Choice("preference", "comparison.preference", options)
    return Page("comparison", title, (choice, scale) if depth else (choice,), levels=levels)


def remarks() -> Page:
    """Free text."""
    return Page("remarks", "remarks.title", (TextField("remarks", "remarks.text"),))


def tlx(title: str, levels: Levels) -> Page:
    """NASA-TLX without weights: six scales of 21 steps, each 0–20."""
    scales = tuple(
        Scale(
            item,
            f"tlx.{item}",
            "tlx.good" if item == "performance" else "tlx.low",
            "tlx.bad" if item == "performance" else "tlx.high",
            steps=21,
        )
        for item in TLX
    )
    return Page(_name("tlx", levels), title, scales, levels=levels)


def sus(title: str, levels: Levels) -> Page:
    """System Usability Scale: ten statements, 0 (strongly disagree) to 4 (strongly agree)."""
    scales = tuple(
        Scale(f"sus_{n}", f"sus.item{n}", "sus.low", "sus.high") for n in range(1, SUS_ITEMS + 1)
    )
    return Page(_name("sus", levels), title, scales, levels=levels)


def _name(kind: str, levels: Levels) -> str:
    return " ".join([kind, *(level for _, level in levels)])


def sus_score(answers: dict[str, str]) -> float:
    """0–100: odd items count as they are, even ones reversed, times 2.5 (Brooke 1996)."""
    values = [int(answers[f"sus_{n}"]) for n in range(1, SUS_ITEMS + 1)]
    return 2.5 * sum(v if n % 2 else 4 - v for n, v in enumerate(values, start=1))
