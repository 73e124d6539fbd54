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
    for key, item in old.body:
        if key is None:
            parts.append(item.as_string())
        elif key.key in OLD_TABLES:
            parts.append(_renamed(key, item))
        elif key.key in GONE:
            parts.append(_table(key.key, item, moved, base.get(key.key, {})))
            parts += [_factors(factors)] if key.key == "design" else []
        else:
            parts.append(_text({key: item}))
    if "design" not in plain:
        parts += [_header("design", base["design"]), _factors(factors)]
    parts += [_header(name, part) for name, part in base.items() if name != "design"]
    parts += [f"[{name}]\n{''.join(lines)}" for name, lines in moved.items() if lines]
    asked = [f"{name} = {_inline(own)}\n" for name, own in questions.items()]
    parts.append("[questions] # in this order\n" + "".join(asked))
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


def _table(name: str, item: Item, moved: dict[str, list[str]], base: Mapping[str, object]) -> str:
    """What of a table stays; entries that move go into `moved` under the names they have now."""
    stays = [f"{key} = {_inline(value)}\n" for key, value in base.items()]
    assert isinstance(item, Table)
    for key, value in item.value.body:
        if key is None:
            stays.append(value.as_string())
        elif (name, key.key) in MOVED:
            table, new = MOVED[name, key.key]
            line = re.sub(rf"^\s*{key.key}\s*=", f"{new} =", _text({key: value}))
            (stays if table == name else moved[table]).append(line)
        elif key.key not in GONE[name]:
            stays.append(_text({key: value}))
    text = "".join(stays)
    comment = item.trivia.comment and f" {item.trivia.comment}"
    return f"[{name}]{comment}\n{text}" if text.strip() else ""


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
