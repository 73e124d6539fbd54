"""The tables of a study file that are the session's own: what each key means, may be, and when it
can change (experiment/study/tables/scopes.py).

Those of worlds, tasks, techniques and questions are declared where those are. All of them make
docs/keys.md (experiment/study/tables/keys.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, JsonValue, field_validator
from pydantic.fields import FieldInfo

from seethrough import registry
from seethrough.experiment.errors import shown
from seethrough.experiment.files.folders import PARTICIPANT
from seethrough.experiment.pages.texts import languages
from seethrough.experiment.study.tables.scopes import BLOCK, FIXED, SESSION
from seethrough.renderer.meant import meant

# What `analysis` knows by these names; a contract test holds both to each other.
AnalysisTest = Literal["time", "accuracy", "ratings", "tradeoff", "validity", "mixed"]
EXCLUSIONS = ("timed_out", "focus_lost", "frames_missed", "too_fast")

TASKS_SAID = f"an array of some of {', '.join(map(shown, registry.known('task')))}, each once"
NAME = "1 to 32 letters and digits (A–Z, a–z, 0–9)"
LANGUAGE = f'one of {", ".join(languages())}, or a file of texts beside the study, as "fr.toml"'
LEDGER = "postgresql://USER@HOST/DATABASE without a password"


def key(
    meaning: str, unit: str = "", said: str = "", scope: str = FIXED, **limits: Any
) -> FieldInfo:
    """What is declared of a key: `said` says what is allowed where the limits do not, `scope` when
    it can change."""
    more: dict[str, JsonValue] = {"unit": unit, "said": said, "scope": scope}
    made: FieldInfo = Field(description=meaning, json_schema_extra=more, **limits)
    return made


def is_plain(name: str) -> bool:
    """Whether a study may be called so: its name is part of the names of files."""
    return name.isascii() and name.isalnum() and len(name) <= 32


def _plain(value: str) -> str:
    if not is_plain(value):
        raise ValueError(NAME)
    return value


def _language(value: str) -> str:
    if value not in languages() and not value.endswith(".toml"):
        raise ValueError(LANGUAGE + meant(value, languages()))
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
        expected = f"one of {', '.join(EXCLUSIONS)} or participant:ID"
        raise ValueError(expected + meant(value, EXCLUSIONS))
    return value


def _task(value: str) -> str:
    if value not in registry.known("task"):
        known = registry.known("task")
        raise ValueError(f"one of {', '.join(map(shown, known))}{meant(value, known)}")
    return value


def as_tuple(value: object) -> object:
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
        key("of all that participants read", scope=SESSION,
            said=LANGUAGE),
    ] = "en"  # fmt: skip


class SelectTable(Table):
    """[design.select]: the rule by which scenes are selected, said before anybody is invited.

    `power --scenes` holds scenes to `factor` and `least`, and the report says that scenes were
    selected; without this table none are.
    """

    factor: Annotated[
        str, key("the factor whose levels are to differ in how much of what is asked for they show "
                 "in every scene; it has to leave scenes alone", said="a factor's name"),
    ] = ""  # fmt: skip
    least: Annotated[
        float | None,
        key("how far those levels are to be apart at least, as a share of what is asked for", gt=0,
            lt=1),
    ] = None  # fmt: skip
    rule: Annotated[
        str, key("the rule in words, where scenes were chosen by hand", said="text, at most 300 "
                 "characters", max_length=300),
    ] = ""  # fmt: skip


class DesignTable(Table):
    """[design]: orders, and what happens in each condition.

    Levels that leave scenes alone are to be equally hard: `check` compares their scenes by
    `tolerance` and `imbalance`; scenes named in `redraw` are drawn again
    (experiment/study/checked/certificate.py).
    """

    order: Annotated[
        Literal["williams", "latin", "fixed", "random"],
        key("square over the conditions of all factors that have no order of their own"),
    ] = "williams"
    tasks: Annotated[
        tuple[Annotated[str, AfterValidator(_task)], ...],
        key("what people do in each condition, in this order in the first slot", scope=BLOCK,
            said=TASKS_SAID, min_length=1),
    ] = ()  # fmt: skip
    trials: Annotated[int, key("trials of each task in each cell", scope=BLOCK, ge=1, le=100)] = 3
    exclude: Annotated[
        tuple[Mapping[str, str | int | float | bool], ...],
        key("cells to leave out, each by levels of some factors",
            said="an array of tables, as { view = \"plain\", clutter = 380 }"),
    ] = ()  # fmt: skip
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

    select: Annotated[
        SelectTable | None, key("the rule by which scenes are selected; none: they are not")
    ] = None

    _arrays = field_validator("tasks", "redraw", "exclude", mode="before")(as_tuple)
    _unique = field_validator("tasks")(_once)


class PracticeTable(Table):
    """[practice]: before the trials of each task set."""

    trials: Annotated[
        int, key("trials to practise on before those of a task set", scope=BLOCK, ge=0, le=20)
    ] = 1
    limit: Annotated[
        float,
        key("most time for the practice trials of a task set; 0: no limit", "s", scope=BLOCK,
            ge=0, le=1e9),
    ] = 300.0  # fmt: skip
    explore: Annotated[
        float,
        key("time to look around freely in a scene before the practice trials, which Enter ends; "
            "0: none", "s", scope=BLOCK, ge=0, le=1e9),
    ] = 0.0  # fmt: skip
    until: Annotated[
        tuple[int, int] | None,
        key("practise until so many of the last so many are right, as [3, 4]; none: `trials`",
            scope=BLOCK, said="two whole numbers from 1 to 20, the first at most the second"),
    ] = None  # fmt: skip
    most: Annotated[
        int, key("practice trials at most, with `until`", scope=BLOCK, ge=1, le=100)
    ] = 20

    _arrays = field_validator("until", mode="before")(as_tuple)

    @field_validator("until")
    @classmethod
    def _some_of_the_last(cls, value: tuple[int, int] | None) -> tuple[int, int] | None:
        if value is not None and not 1 <= value[0] <= value[1] <= 20:
            raise ValueError("two whole numbers from 1 to 20, the first at most the second")
        return value

    @property
    def count(self) -> int:
        """Practice trials that there may be."""
        return self.trials if self.until is None else self.most


class TaskTable(Table):
    """[task]: what holds for each; a [task.NAME] may say otherwise of itself."""

    limit: Annotated[
        float,
        key("most time for a trial, then it counts as timed out; 0: no limit", "s", scope=BLOCK,
            ge=0, le=1e9),
    ] = 0.0  # fmt: skip
    confidence: Annotated[
        bool, key("after each answer, how sure one is of it: a measure of the task", scope=BLOCK)
    ] = False
    unsure: Annotated[
        bool, key('whether a trial may be ended by "I don\'t know": a button, and F2', scope=BLOCK)
    ] = False


class DisplayTable(Table):
    """[display]: the window, and what it promises."""

    width: Annotated[int, key("width of the window", "pixels", scope=SESSION, ge=1, le=8192)] = 800
    height: Annotated[int, key("height of the window", "pixels", scope=SESSION, ge=1, le=8192)] = (
        600
    )
    fullscreen: Annotated[
        bool, key("fill the screen, whatever `width` and `height` say", scope=SESSION)
    ] = False
    refresh: Annotated[
        float, key("refresh rate of the display; a frame of over 1.5 periods is missed", "Hz",
                   scope=SESSION, ge=10, le=1000),
    ] = 60.0  # fmt: skip
    samples: Annotated[
        Literal["auto", 0, 2, 4, 8],
        key("samples a pixel where look.antialiasing is auto; auto: 4 on a graphics card, none "
            "without, where they would miss 60 Hz", scope=SESSION),
    ] = "auto"  # fmt: skip


class SessionTable(Table):
    """[session]: its limit, and what becomes of a broken-off session."""

    limit: Annotated[
        float, key("most time for the session, then it ends; 0: no limit", "s", ge=0, le=1e9)
    ] = 4800.0
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


class PredictionTable(Table):
    """[[analysis.predictions]]: what is expected, stated before there are data."""

    name: Annotated[str, key("what the report calls it, as P1", min_length=1, max_length=32)]
    measure: Annotated[
        str | tuple[str, ...], key("the measure, or several", said="a measure's name, or an array")
    ]
    contrast: Annotated[str, key("the factor whose levels are compared with its baseline")] = ""
    expect: Annotated[
        Literal["less", "more", "different", "equivalent", "not worse", "at least"],
        key("how the levels differ from the baseline, or what the mean is"),
    ]
    level: Annotated[str, key("the level that is compared; empty: each")] = ""
    value: Annotated[float | None, key("what the mean is compared with")] = None
    margin: Annotated[
        Mapping[str, float] | float | None,
        key("the largest difference that would not matter, in the measure's unit",
            said="a number, or one for each measure, as { time = 2.0 }"),
    ] = None  # fmt: skip
    ratio: Annotated[float | None, key("the same as a ratio, for ratio scales", gt=1)] = None
    combine: Annotated[Literal["all", "any"], key("of several measures")] = "all"
    reason: Annotated[str, key("why it is expected, for the report")] = ""

    _arrays = field_validator("measure", mode="before")(as_tuple)


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
    pairwise: Annotated[
        tuple[str, ...],
        key("factors of which every pair of levels is compared, not only each with the baseline",
            said="an array of factors' names"),
    ] = ()  # fmt: skip
    aligned_ranks: Annotated[
        bool, key("test interactions of ordinal measures by aligned ranks, too, with a warning")
    ] = False
    margins: Annotated[MarginsTable, key("differences that would not matter")] = MarginsTable()
    predictions: Annotated[
        tuple[PredictionTable, ...],
        key("what is expected, a table `[[analysis.predictions]]` each",
            said="an array of tables, [[analysis.predictions]]"),
    ] = ()  # fmt: skip

    _arrays = field_validator("tests", "exclude", "pairwise", "predictions", mode="before")(
        as_tuple
    )
    _unique = field_validator("tests", "exclude", "pairwise")(_once)


# The tables that are checked here, by their names; `factors` and those of plug-ins beside them.
TABLES: dict[str, type[Table]] = {
    "study": StudyTable,
    "design": DesignTable,
    "practice": PracticeTable,
    "display": DisplayTable,
    "session": SessionTable,
    "analysis": AnalysisTable,
}
