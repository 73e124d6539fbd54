"""The design as one page: slots × positions, each square a condition by its colour.

A page of its own: no script, no network, readable in print and without colours (letters).
"""

from __future__ import annotations

from html import escape

from seethrough.experiment.study.design.design import session_for
from seethrough.experiment.study.design.items import letters
from seethrough.experiment.study.shown.design_table import conditions_of, lines_of
from seethrough.experiment.study.study import Study

MOST_SLOTS = 200  # rows of the picture
STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem; padding: 0 1rem;
       color: #1b1b1b; background: #fff; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
pre { background: #f4f4f2; padding: 1rem; overflow-x: auto; font-size: 13px; }
table { border-collapse: separate; border-spacing: 2px; }
th { font-weight: normal; color: #444; text-align: right; padding-right: .5rem; font-size: 13px; }
thead th { text-align: center; padding: 0; }
td { min-width: 2rem; height: 1.6rem; text-align: center; font-size: 13px; color: #111; }
ul.legend { list-style: none; padding: 0; columns: 18rem; }
ul.legend li { padding: .2rem 0; break-inside: avoid; }
ul.legend span { display: inline-block; min-width: 2rem; text-align: center; margin-right: .5rem; }
@media print { td, ul.legend span { print-color-adjust: exact; } }
"""


def page(study: Study, count: int) -> str:
    """The page of the first people's sessions."""
    plan = study.plan
    every = list(dict.fromkeys(
        "/".join(levels.values()) or "(one)"
        for which in range(len(plan.groups))
        for levels in plan.conditions(which)
    ))  # fmt: skip
    looks = {name: (letters(k), color(k, len(every))) for k, name in enumerate(every)}
    title = f"{study.general.title}: the design"
    parts = [
        f"<!doctype html><html lang='en'><meta charset='utf-8'><title>{escape(title)}</title>",
        f"<meta name='viewport' content='width=device-width'><style>{STYLE}</style>",
        f"<main><h1>{escape(title)}</h1><p>{escape(study.general.description)}</p>",
        "<h2>Conditions</h2><ul class='legend'>",
        *(f"<li>{_square(looks[name], 'span')}{escape(name)}</li>" for name in every),
        "</ul>",
    ]
    for which, group in enumerate(plan.groups):
        name = "/".join(group.levels.values())
        slots = [s for s in plan.slots(count) if plan.group_of(s)[0] == which]
        parts.append(f"<h2>{escape(name or 'Who meets what when')}: {len(slots)} people</h2>")
        parts.append(_table(study, slots[:MOST_SLOTS], looks))
        parts += [f"<p>{escape(said)}</p>" for said in _mixed(study)]
        if len(slots) > MOST_SLOTS:
            parts.append(f"<p>… and {len(slots) - MOST_SLOTS} more.</p>")
    lines = escape("\n".join(lines_of(study, count)))
    parts.append(f"<h2>In words</h2><pre tabindex='0'>{lines}</pre></main></html>")
    return "\n".join(parts)


def _mixed(study: Study) -> list[str]:
    """What no colour shows: levels that change from trial to trial within a block."""
    return [
        f"Within a block its trials mix the levels of {factor.name}: {', '.join(factor.names)}."
        for factor in study.factors
        if factor.mixed
    ]


def _table(study: Study, slots: list[int], looks: dict[str, tuple[str, str]]) -> str:
    rows = [(s, conditions_of(study, session_for(s, study.plan))) for s in slots]
    widest = max((len(conditions) for _, conditions in rows), default=0)
    head = "".join(f"<th scope='col'>{k}</th>" for k in range(1, widest + 1))
    lines = [
        f"<tr><th scope='row'>slot {slot}</th>"
        + "".join(_square(looks[name], "td", name) for name in conditions)
        + "</tr>"
        for slot, conditions in rows
    ]
    top = f"<thead><tr><th scope='col'>block</th>{head}</tr></thead>"
    return f"<table>{top}<tbody>{''.join(lines)}</tbody></table>"


def _square(look: tuple[str, str], tag: str, title: str = "") -> str:
    letter, background = look
    said = f" title='{escape(title, quote=True)}'" if title else ""
    return f"<{tag} style='background:{background}'{said}>{letter}</{tag}>"


def color(k: int, of: int) -> str:
    """Light colours that hold dark letters, apart in hue, neighbours in lightness, too."""
    return f"hsl({360 * k / max(of, 1):.0f} 70% {(82, 68)[k % 2]}%)"
