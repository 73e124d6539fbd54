"""The tables of a study file that are the session's own: what each key means and may be.

Those of scenes and of the technique are declared where they are used (tasks/parameters.py,
renderer/techniques/). All of them make docs/keys.md (experiment/study/keys.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, field_validator

from seethrough.experiment.files.folders import PARTICIPANT
from seethrough.experiment.pages.texts import languages
from seethrough.experiment.study.design import Factors

TaskName = Literal["count", "pattern", "unique", "count_in_building"]
TASK_SCENARIO: Mapping[str, str] = {
    "count": "abstract",
    "pattern": "abstract",
    "unique": "walkthrough",
    "count_in_building": "walkthrough",
}

QuestionnaireBlock = Literal["ratings", "comparison", "tlx", "sus", "depth_test", "remarks"]

# What `analysis` knows by these names; a contract test holds both to each other.
AnalysisTest = Literal["time", "accuracy", "ratings", "tradeoff", "validity", "mixed"]
EXCLUSIONS = ("timed_out", "focus_lost", "frames_missed", "too_fast")

NAME = "1 to 32 letters and digits (A–Z, a–z, 0–9)"
LEDGER = "postgresql://USER@HOST/DATABASE without a password"


def key(meaning: str, unit: str = "", said: str = "", **limits: Any) -> Any:
    """What is declared of a key: `said` says what is allowed where the limits do not."""
    return Field(description=meaning, json_schema_extra={"unit": unit, "said": said}, **limits)


def _plain(value: str) -> str:
    if not (value.isascii() and value.isalnum() and len(value) <= 32):
        raise ValueError(NAME)
    return value


def _language(value: str) -> str:
    if value not in languages():
        raise ValueError(f"one of {', '.join(languages())}")
    return value


def _ledger(value: str) -> str:
    scheme, found, rest = value.partition("postgresql://")
    user, at, place = rest.rpartition("@")
    named = user and not set(":@/") & set(user) if at else not user
    if value and not (found and not scheme and place and named and "\n" not in value):
        raise ValueError(LEDGER)
    return value


def _exclusion(value: str) -> str:
    kind, _, name = value.partition(":")
    if value not in EXCLUSIONS and not (kind == "participant" and PARTICIPANT.fullmatch(name)):
        raise ValueError(f"one of {', '.join(EXCLUSIONS)} or participant:ID")
    return value


def _as_tuple(value: Any) -> Any:
    """TOML has arrays, frozen tables have tuples."""
    return tuple(value) if isinstance(value, list) else value


def _once(value: tuple[str, ...]) -> tuple[str, ...]:
    if len(set(value)) < len(value):
        raise ValueError("each name once")
    return value


class Table(BaseModel):
    """A table of the study file: no unknown keys, no conversions, frozen."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


class StudyTable(Table):
    """[study]: what it is."""

    name: Annotated[str, AfterValidator(_plain), key("starts the names of all files", said=NAME)]
    title: Annotated[
        str, key("what participants read in the window's frame, and the report's title",
                 said="text of 1 to 200 characters", min_length=1, max_length=200),
    ]  # fmt: skip
    description: Annotated[
        str, key("goes into the data folder, for those who find it", said="text", min_length=1)
    ]
    participants: Annotated[int, key("how many people are wanted", ge=1, le=10_000)]
    seed: Annotated[
        int, key("makes every random choice of scenes and orders", ge=0, lt=2**63,
                 said="a whole number from 0 to 2^63 − 1"),
    ]  # fmt: skip
    language: Annotated[
        str, AfterValidator(_language),
        key("of all that participants read", said=f"one of {', '.join(languages())}"),
    ] = "en"  # fmt: skip


class DesignTable(Table):
    """[design]: what is crossed, and how often.

    Transparency levels are to be equally hard: `check` compares their scenes by `tolerance` and
    `imbalance`; scenes named in `redraw` are drawn again (experiment/study/certificate.py).
    """

    transparency: Annotated[
        tuple[Literal["standard", "dynamic"], ...],
        key("levels of transparency, each participant meets all", min_length=1, max_length=2),
    ] = ("standard", "dynamic")
    tasks: Annotated[
        tuple[TaskName, ...],
        key("T1 count, T2 pattern, T3 unique, T4 count_in_building", min_length=1),
    ] = ("count", "pattern", "unique", "count_in_building")
    trials: Annotated[int, key("trials of each task in each condition", ge=1, le=100)] = 3
    training: Annotated[int, key("trials to practise on before those", ge=0, le=20)] = 1
    redraw: Annotated[
        tuple[str, ...],
        key("scenes to draw again, so that the levels match: `check --redraw` prints the line"),
    ] = ()
    tolerance: Annotated[
        float,
        key("how far the levels' shares of targets that can be seen, or that are hidden, may be "
            "apart", gt=0, le=1),
    ] = 0.05  # fmt: skip
    imbalance: Annotated[
        float,
        key("how far the levels' numbers of targets, occluders and visible things and their ways "
            "to walk may be apart, as a share of their mean", gt=0, le=2),
    ] = 0.2  # fmt: skip

    _arrays = field_validator("transparency", "tasks", "redraw", mode="before")(_as_tuple)
    _unique = field_validator("transparency", "tasks")(_once)

    def factors(self) -> Factors:
        """The design's factors, tasks grouped by scenario in the order of the scenarios."""
        scenarios = ("abstract", "walkthrough")
        tasks = {s: tuple(t for t in self.tasks if TASK_SCENARIO[t] == s) for s in scenarios}
        present = {s: ts for s, ts in tasks.items() if ts}
        return Factors(self.transparency, present, self.trials, self.training, redraw=self.redraw)


class DisplayTable(Table):
    """[display]: the window, and what it promises."""

    width: Annotated[int, key("width of the window", "pixels", ge=1, le=8192)] = 800
    height: Annotated[int, key("height of the window", "pixels", ge=1, le=8192)] = 600
    fullscreen: Annotated[bool, key("fill the screen, whatever `width` and `height` say")] = False
    refresh: Annotated[
        float, key("refresh rate of the display; a frame of over 1.5 periods is missed", "Hz",
                   ge=10, le=1000),
    ] = 60.0  # fmt: skip
    samples: Annotated[
        Literal["auto", 0, 2, 4, 8],
        key("samples a pixel, against jagged edges; auto: 4 on a graphics card, none without, "
            "where they would miss 60 Hz"),
    ] = "auto"  # fmt: skip


class SessionTable(Table):
    """[session]: limits, pages before and after, and what becomes of a broken-off session."""

    training_limit: Annotated[
        float,
        key("most time for the practice trials of a task set; 0: no limit", "s", ge=0, le=1e9),
    ] = 300.0
    trial_limit: Annotated[
        float,
        key("most time for a trial, then it counts as timed out; 0: no limit", "s", ge=0, le=1e9),
    ] = 0.0
    session_limit: Annotated[
        float, key("most time for the session, then it ends; 0: no limit", "s", ge=0, le=1e9)
    ] = 4800.0
    consent: Annotated[
        str, key("text file beside the study's, shown first and to be agreed to; empty: none")
    ] = ""
    demographics: Annotated[bool, key("ask for age and gender before the first trial")] = False
    color_check: Annotated[bool, key("show plates that tell who confuses red and green")] = False
    questionnaire: Annotated[
        tuple[QuestionnaireBlock, ...], key("pages after the last trial, in this order")
    ] = ("ratings", "comparison", "remarks")
    resume: Annotated[
        Literal["block", "trial"],
        key("where a broken-off session goes on: at the start of the block, or at the trial"),
    ] = "block"
    stale_after: Annotated[
        float,
        key("an open session not heard of for so long loses its slot to whoever needs one", "s",
            ge=0, le=1e9),
    ] = 86_400.0  # fmt: skip
    # Where slots are kept is no part of what is studied: not in the digest, nor in any sidecar.
    ledger: Annotated[
        str, AfterValidator(_ledger),
        key("address of a PostgreSQL that many stations share (its password belongs into "
            "PostgreSQL's own password file); empty: a file in the data folder", said=LEDGER,
            exclude=True),
    ] = ""  # fmt: skip

    _arrays = field_validator("questionnaire", mode="before")(_as_tuple)
    _unique = field_validator("questionnaire")(_once)


class MarginsTable(Table):
    """[analysis.margins]: differences that would not matter; a measure without one has none.

    They are declared before there are data: equivalence, and that accuracy does not suffer, are
    tested against them.
    """

    time: Annotated[float | None, key("of completion times, as a ratio", gt=1, le=1e3)] = None
    count_error: Annotated[
        float | None, key("of the share that a count is off by", gt=0, le=1e3)
    ] = None
    correct: Annotated[float | None, key("of the share of right answers", gt=0, lt=1)] = None
    distance: Annotated[
        float | None, key("of the distance of a mark", "world units", gt=0, le=1e9)
    ] = None


class AnalysisTable(Table):
    """[analysis]: what is decided before anybody is invited; the report lists deviations."""

    alpha: Annotated[float, key("level of significance", gt=0, lt=1)] = 0.05
    tests: Annotated[tuple[AnalysisTest, ...], key("sections of the report that were planned")] = ()
    exclude: Annotated[
        tuple[Annotated[str, AfterValidator(_exclusion)], ...],
        key("trials or people to leave out",
            said=f"an array of some of {', '.join(EXCLUSIONS)}, participant:ID"),
    ] = ()  # fmt: skip
    too_fast: Annotated[
        float, key("an answer sooner than this is impossible: what `exclude` leaves out by that "
                   "name", "s", gt=0, le=1e9),
    ] = 0.2  # fmt: skip
    margins: Annotated[MarginsTable, key("differences that would not matter")] = MarginsTable()

    _arrays = field_validator("tests", "exclude", mode="before")(_as_tuple)
    _unique = field_validator("tests", "exclude")(_once)
