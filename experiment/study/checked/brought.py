"""What `check` says of all that a study brings along: texts, models, scenes, and what trials make
of them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from seethrough.experiment.errors import shown
from seethrough.experiment.study.beside.own_model_files import models_of
from seethrough.experiment.study.study import Study
from seethrough.experiment.study.translations import is_own, languages_of
from seethrough.experiment.verdicts import OK, WARNING, Verdicts
from seethrough.tasks.kit.world import FILES

if TYPE_CHECKING:
    from moderngl import Context


def texts(study: Study, path: Path, said: Verdicts) -> None:
    """Translations of what is another text by now."""
    for language in filter(is_own, languages_of(study)):
        from seethrough.experiment.study.translated_from import stale_in

        for key, (before, now) in stale_in(study, path, language).items():
            text = f"{language}: {key}: translated from {shown(before)}, which is {shown(now)} now"
            why = "expected a translation of that, with it in the comment above"
            said.say("texts", text, WARNING, why)


def models(study: Study, said: Verdicts) -> None:
    """What the study brings along: read already, or there would be no study."""
    if models_of(study):
        from seethrough.experiment.study.checked.contact_sheet import described, facts_of
    for own in models_of(study):
        first, *more = described(own, facts_of(own), study)
        said.say("model", f"{own.name}: {own.file}, {first}, {own.sha256[:12]}")
        for line in more:
            print(f"{'':<11} {line}")


def trial_scenes(study: Study, said: Verdicts) -> None:
    """What is odd about the scenes that trials are made in, which no picture has to tell."""
    from seethrough.experiment.study.checked.trial_scenes import odd_files, odd_trials

    for text, verdict, why in (*odd_files(study), *odd_trials(study)):
        said.say("scenes", text, verdict, why)


def model_sheet(
    study: Study, context: Context, path: Path | None, file: str, said: Verdicts
) -> None:
    """The own models of the study in a file in a picture, where it has any."""
    if models_of(study):
        from seethrough.experiment.study.checked import contact_sheet

        path = path or contact_sheet.default_path(file)
        contact_sheet.write(study, context, path)
        said.say("models", f"a picture of each from several sides, in {path}", OK, "look at it")


def scenes(study: Study, context: Context, path: Path | None, file: str, said: Verdicts) -> None:
    """The own scenes of the study in a file: how large they are, what is seen of them from where;
    a picture."""
    if all(place.scenes != FILES for place in study.places()):
        return
    from seethrough.experiment.study.checked import scene_sheet

    found = []
    for p, own in scene_sheet.scenes_of(study):
        seen = scene_sheet.looked_at(study, context, p, own)
        found.append(seen)
        text, odd = scene_sheet.described(p, seen.place)
        said.say("scene", text, *([WARNING, odd] if odd else []))
        for line in scene_sheet.seen_lines(seen):
            print(f"{'':<11} {line}")
    if found:
        path = path or scene_sheet.default_path(file)
        scene_sheet.write(found, context, path)
        said.say("scenes", f"a picture of each from every view, in {path}", OK, "look at it")
