"""A study file of earlier versions in the present language: comments stay with their keys."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping

import tomlkit
from tomlkit.items import Item, Key, Table

from seethrough.experiment.study.migrate import (
    NAMES,
    OLD_TABLES,
    Factors,
    Tables,
    factors_of,
    questions_of,
)

MOVED = {
    ("design", "training"): ("practice", "trials"),
    ("session", "training_limit"): ("practice", "limit"),
    ("session", "trial_limit"): ("task", "limit"),
    ("session", "session_limit"): ("session", "limit"),
}
GONE = {
    "design": ("transparency", "tasks"),
    "session": ("consent", "demographics", "color_check", "questionnaire"),
}


def migrated_text(text: str) -> str:
    """The file's text in the present language."""
    old = tomlkit.parse(text)
    plain: Mapping[str, object] = old.unwrap()
    own = {n: dict(t) for n, t in plain.items() if isinstance(t, Mapping)}
    factors, base = factors_of(own.get("design", {}))
    questions = questions_of(own.get("session", {}), factors)
    parts: list[str] = []
    moved: dict[str, list[str]] = {"practice": [], "task": []}
    said: dict[str, list[str]] = {}
    for key, item in old.body:
        if key is None:
            parts.append(item.as_string())
        elif key.key in OLD_TABLES:
            parts.append(_renamed(key, item))
        elif key.key in GONE:
            parts.append(_table(key.key, item, moved, base.get(key.key, {}), said))
            parts += [_factors(factors)] if key.key == "design" else []
        else:
            parts.append(_text({key: item}))
    if "design" not in plain:
        parts += [_header("design", base["design"]), _factors(factors)]
    parts += [_header(name, part) for name, part in base.items() if name != "design"]
    parts += [f"[{name}]\n{''.join(lines)}" for name, lines in moved.items() if lines]
    parts.append("[questions] # in this order\n" + _questions(questions, said))
    return "\n".join(part.rstrip("\n") + "\n" for part in parts if part.strip())


def _text(entries: Mapping[Key, Item]) -> str:
    """Keys and values as the file has them."""
    made = tomlkit.document()
    for key, item in entries.items():
        made.append(key, item)
    return tomlkit.dumps(made)


def _renamed(key: Key, item: Item) -> str:
    """A table under the name that it has now, and the tables in it."""
    name = key.key
    new = f"{OLD_TABLES[name]}.{NAMES[name]}"
    return re.sub(rf"^(\s*\[\[?){name}(?=[\].])", rf"\g<1>{new}", _text({key: item}), flags=re.M)


def _questions(questions: Mapping[str, object], said: Mapping[str, list[str]]) -> str:
    """A line each, with what was said about it and about the pages at the end."""
    lines = said.get("questionnaire", [])
    for name, own in questions.items():
        lines = [*lines, *said.get(name, []), f"{name} = {_inline(own)}\n"]
    return "".join(lines)


def _table(
    name: str, item: object, moved: dict[str, list[str]], base: Mapping[str, object],
    said: dict[str, list[str]],
) -> str:  # fmt: skip
    """What of a table stays; entries that move go into `moved` under the names they have now, with
    the comments above them, and of those that are gone the comments alone into `said`."""
    stays = [f"{key} = {_inline(value)}\n" for key, value in base.items()]
    above: list[str] = []
    assert isinstance(item, Table)
    for key, value in item.value.body:
        if key is None:
            above.append(value.as_string())
            continue
        gone = key.key in GONE[name]
        table, new = MOVED.get((name, key.key), (name, key.key))
        line = re.sub(rf"^\s*{key.key}\s*=", f"{new} =", _text({key: value}))
        own = next((i for i in range(len(above), 0, -1) if not above[i - 1].strip()), 0)
        if gone or table != name:  # only the comments that stand right above it are about it
            stays += above[:own]
            kept = said.setdefault(key.key, []) if gone else moved[table]
            kept += above[own:]
            if gone:
                _tell(key.key, line, said)
            else:
                kept.append(line)
        else:
            stays += [*above, line]
        above = []
    stays += above
    text = "".join(stays)
    comment = item.trivia.comment and f" {item.trivia.comment}"
    return f"[{name}]{comment}\n{text}" if text.strip() else ""


def _tell(key: str, text: str, said: dict[str, list[str]]) -> None:
    """The comments of an entry that is gone: of an array's line, about what stands in that line."""
    for line in text.splitlines():
        plain = re.sub(r'"[^"]*"', lambda found: "_" * len(found[0]), line)
        at = plain.find("#")
        if at >= 0:
            names = re.findall(r'"(\w+)"', line[:at])
            about = names[0] if len(names) == 1 and key == "questionnaire" else key
            said.setdefault(about, []).append(f"{line[at:].rstrip()}\n")


def _header(name: str, part: Mapping[str, object]) -> str:
    return f"[{name}]\n" + "".join(f"{k} = {_inline(v)}\n" for k, v in part.items())


def _factors(factors: Factors) -> str:
    return "\n".join(
        f"[factors.{name}]\n"
        + "".join(f"levels.{level} = {_dotted(part)}\n" for level, part in own["levels"].items())
        for name, own in factors.items()
    )


def _dotted(part: Tables) -> str:
    """A part of a study in one line: { technique.use = "dynamic" }."""
    said = ", ".join(
        f"{table}.{key} = {_inline(value)}"
        for table, own in part.items()
        for key, value in own.items()
    )
    return f"{{ {said} }}"


def _inline(value: object) -> str:
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{k} = {_inline(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_inline, value))}]"
    return json.dumps(value, ensure_ascii=False)
