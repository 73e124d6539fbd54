"""Malformed studies, continued: questions of a study's own, its language, and plug-ins in files."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from seethrough.experiment.study.config import parse
from seethrough.experiment.study.translations import needed

LIKERT: dict[str, Any] = {"use": "likert", "when": "condition", "text": "It was hard.", "points": 7}
Made = tuple[str, dict[str, Any], Mapping[str, bytes]]  # what, the study, files beside it


def _pick(rng: np.random.Generator, options: Any) -> Any:
    return options[int(rng.integers(len(options)))]


def question(base: Mapping[str, Any], rng: np.random.Generator) -> Made:
    """Every way to write a question wrongly, conditions and circles among them."""
    study = copy.deepcopy(dict(base))
    asked = study["questions"] = {"hard": dict(LIKERT), "why": {"use": "text", "text": "Why?"}}
    hard, why = asked["hard"], asked["why"]
    wrong: dict[str, Callable[[], object]] = {
        "unknown kind": lambda: hard.update(use=_pick(rng, ["liker", "", "x" * 300, "\n"]) or "no"),
        "unknown key": lambda: hard.update(pionts=7),
        "no such moment": lambda: hard.update(when=_pick(rng, ["often", "\x1b"]) + "x"),
        "unknown factor": lambda: hard.update(each=["view"]),
        "factors that are none": lambda: hard.update(each=_pick(rng, ["scenario", 3, [1], [[]]])),
        "only at no level": lambda: hard.update(only={"scenario": "nowhere"}),
        "only at no factor": lambda: hard.update(only={"view": "plain"}),
        "compares nothing": lambda: hard.update(of="view"),
        "given nothing": lambda: why.update(given={"nothing": 1}),
        "given itself": lambda: why.update(given={"why": "x"}),
        "given what comes later": lambda: hard.update(given={"why": "x"}),
        "a circle": lambda: (hard.update(given={"why": "x"}), why.update(given={"hard": 1})),
        "given no value": lambda: why.update(
            given={"hard": _pick(rng, [[], {}, True, [[]], {"lest": 1}, {"least": "x"}])}),
        "given no table": lambda: why.update(given=_pick(rng, [3, "hard", ["hard"], True])),
        "no order": lambda: hard.update(order=_pick(rng, ["random", 3, True, "\n"])),
        "shuffled with what it needs": lambda: (
            hard.update(when="end", order="shuffled"),
            why.update(order="shuffled", given={"hard": 1})),
        "too many points": lambda: hard.update(points=_pick(rng, [1, 1000, "7", 2.5, True])),
        "ends": lambda: hard.update(ends=_pick(rng, [["a"], ["a", "b", "c"], "ab", [1, 2], 3])),
        "items beside text": lambda: hard.update(items=["a", "b"]),
        "names that are too few": lambda: hard.update(text="", items=["a", "b"], names=["x"]),
        "no such item": lambda: hard.update(names=["a"], reverse=["b"]),
        "pages": lambda: hard.update(per_page=_pick(rng, [-1, 1000, "2", 1.5])),
        "a score of what may be left open": lambda: hard.update(score="s", required=False),
        "no text": lambda: why.pop("text"),
        "text that is none": lambda: why.update(text=_pick(rng, [3, [1], {"a": 1}, True])),
        "one option": lambda: asked.update(c={"use": "choice", "text": "?", "options": ["a"]}),
        "an option twice": lambda: asked.update(
            c={"use": "ranking", "text": "?", "options": ["a", "b", "a"]}),
        "right that is none": lambda: asked.update(
            c={"use": "choice", "text": "?", "options": ["a", "b"], "right": "c"}),
        "low above high": lambda: asked.update(
            n={"use": "number", "text": "?", "low": 9, "high": 1}),
        "letters that there are not": lambda: why.update(text="漢字"),
        "weights": lambda: asked.update(tlx={"weighted": _pick(rng, [1, "yes", [True]])}),
        "a mixed factor between trials": lambda: (
            study["factors"].update(side={"set": "world.abstract.side", "values": [80.0, 90.0],
                                          "order": "mixed"}),
            hard.update(each=["side"])),
        "an option of a task": lambda: study.update(
            task={_pick(rng, ["confidence", "unsure"]): _pick(rng, [1, "yes", [True], {}])}),
    }  # fmt: skip
    what = _pick(rng, list(wrong))
    wrong[what]()
    return what, study, {}


def language(base: Mapping[str, Any], rng: np.random.Generator) -> Made:
    """A language of the study's own: its file, and each text in it."""
    study = copy.deepcopy(dict(base))
    study["study"] = {**study["study"], "language": "fr.toml"}
    texts = dict(_french(base))
    key = _pick(rng, list(texts))
    nasty = _pick(rng, ["漢", "\u0000", "🙂", "ق"])
    how = _pick(rng, ["missing", "empty", "unknown", "a place", "letters", "no text", "TOML",
                      "no file", "elsewhere", "not UTF-8"])  # fmt: skip
    if how == "missing":
        del texts[key]
    elif how == "empty":
        texts[key] = _pick(rng, ["", " ", "\t"])
    elif how == "unknown":
        texts[f"{key}x"] = "texte"
    elif how == "a place":
        texts[key] += _pick(rng, [" {x}", " {answer2}"])
    elif how == "letters":
        texts[key] += nasty
    lines = [f"{_dotted(k)} = {json.dumps(v)}" for k, v in texts.items()]
    if how == "no text":
        at = list(texts).index(key)
        lines[at] = f"{_dotted(key)} = {_pick(rng, ['3', '[]', 'true', '0.5', '2026-01-02'])}"
    elif how == "TOML":
        lines.insert(int(rng.integers(len(lines))), _pick(rng, ["= 3", "a b = 1", "[x", '"a = 1']))
    data = "\n".join(lines).encode("utf-8", "surrogatepass")
    if how == "not UTF-8":
        data = data[:40] + b"\xff" + data[40:]
    elif how == "elsewhere":
        study["study"]["language"] = _pick(rng, ["../fr.toml", "/fr.toml", "x/fr.toml", ".toml"])
    return f"{how} {key}", study, {} if how == "no file" else {"fr.toml": data}


_texts: dict[str, str] = {}


def _french(base: Mapping[str, Any]) -> Mapping[str, str]:
    """What has to be there, as it is in English: any text will do."""
    if not _texts:
        plain = needed(parse(base, "base"))
        _texts.update({k: v or "rien" for k, v in plain.items()})
    return _texts


def _dotted(key: str) -> str:
    return ".".join(json.dumps(part) for part in key.split("."))


def plug_in(base: Mapping[str, Any], rng: np.random.Generator) -> Made:
    """An entry that names code: no file, no place for one, or nobody who trusts it."""
    study = copy.deepcopy(dict(base))
    kind = _pick(rng, ["technique", "world", "task", "question"])
    code = {"mine.py": b"raise SystemExit('it ran')\n"}
    how = _pick(rng, ["not trusted", "no file", "elsewhere", "no text", "a folder",
                      "a name of ours", "keys beside", "a described one"])  # fmt: skip
    own: Any = {"file": "mine.py"}
    name = "mine"
    if how == "no file":
        code = {}
    elif how == "elsewhere":
        own = {"file": _pick(rng, ["../mine.py", "/mine.py", "C:\\mine.py", "a/../../mine.py"])}
    elif how == "no text":
        own = {"file": _pick(rng, [3, True, ["mine.py"], {"a": 1}, 0.5])}
    elif how == "a folder":
        own = {"file": _pick(rng, [".", "x", "mine.toml"])}
    elif how == "a name of ours":
        name = {"technique": "dynamic", "world": "abstract", "task": "count", "question": "likert"}[
            kind
        ]
    elif how == "keys beside" and kind == "question":
        own = {"file": "mine.py", "text": "?"}
    if how == "a described one":
        study["plugins"] = [{"kind": kind, "name": name, "file": "mine.py", "sha256": "0" * 64}]
    else:
        study.setdefault(kind, {})[name] = own
    return f"{how} {kind}", study, code


OWN = {"question": question, "language": language, "plug-in": plug_in}
