"""docs/api.md: what code outside may rely on, a line each, from the code itself."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from seethrough import api
from seethrough.experiment.generated import write_anew

SENTENCE = re.compile(r"(?<=[^.])\.\s+(?=[A-Z`])")
PAGE = Path(__file__).parents[2] / "docs" / "api.md"
CHAPTERS = {  # beginning of a module's name → the chapter that its names stand in
    "seethrough.analysis": "Data and results",
    "seethrough.experiment": "Questions",
    "seethrough.renderer.declared": "Parameters",
    "seethrough.renderer.techniques": "Techniques",
    "seethrough.renderer": "Scenes",
    "seethrough.tasks.kit.world": "Worlds",
    "seethrough.tasks.kit.skills": "Simulated people",
    "seethrough.tasks": "Tasks",
}
ORDER = ("Parameters", "Scenes", "Techniques", "Worlds", "Tasks", "Simulated people", "Questions",
         "Data and results")  # fmt: skip


def page() -> str:
    """The page as it has to be."""
    found: dict[str, list[str]] = {chapter: [] for chapter in ORDER}
    modules: dict[str, ModuleType] = {}
    for name in api.__all__:
        value = getattr(api, name)
        if isinstance(value, ModuleType):
            modules[name] = value
        elif name != "VERSION":
            found[_chapter(value)].append(f"- `{name}`: {_said(value)}")
    parts = [_HEAD.format(version=api.VERSION)]
    parts += ["\n".join((f"## {chapter}\n", *lines)) for chapter, lines in found.items()]
    parts += ["\n".join((f"## Module `{n}`\n", *_of(m))) for n, m in modules.items()]
    return "\n\n".join(parts) + "\n"


def _chapter(value: object) -> str:
    where = str(getattr(value, "__module__", ""))
    for start, chapter in CHAPTERS.items():
        if where.startswith(start):
            return chapter
    # A type's other name does not say where it stands.
    return "Questions" if value is api.Row else "Simulated people"


def _of(module: ModuleType) -> Iterator[str]:
    """A module's text and its public names."""
    yield f"{_said(module)}\n"
    for name, value in vars(module).items():
        own = getattr(value, "__module__", module.__name__) == module.__name__
        if name.startswith("_") or isinstance(value, ModuleType) or not own:
            continue
        if inspect.isclass(value) or inspect.isfunction(value):
            yield f"- `{name}`: {_said(value)}"
    constants = [f"`{n}`" for n in vars(module) if n.isupper() and len(n) > 1 and n[0] != "_"]
    if constants:
        yield f"- Values: {', '.join(constants)}."


def _said(value: object) -> str:
    """The first sentence of what is said of it."""
    if value is api.Row:
        return "A row of the questionnaire's table: column → text."
    if value is api.Play:
        return "How a trial is played: events come out, glances go in."
    text = " ".join((inspect.getdoc(value) or "").split("\n\n")[0].split())
    return SENTENCE.split(text)[0].rstrip(".:") + "."


_HEAD = """# What code outside may rely on

Made by `python -m seethrough.experiment.suites.api_page` from `seethrough/api.py`: change that, not
this page. This is version {version} (`seethrough.api.VERSION`), which grows when something here
goes or changes its meaning. What stands nowhere here may move at any time. The guide's chapters
"My scene", "My task" and "My questions" and docs/notebook.md have worked examples, and
`seethrough new KIND` writes a package with one to begin with."""


if __name__ == "__main__":
    sys.exit(write_anew(PAGE, page, "It lists what seethrough.api has."))
