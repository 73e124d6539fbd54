"""The pages around the trials: what is asked, and what becomes of the answers."""

import tomllib
from itertools import chain

import numpy as np
import pytest

from seethrough.experiment.display.display import Leave
from seethrough.experiment.errors import InputError
from seethrough.experiment.pages.color_plates import FIGURE, GROUND, plates
from seethrough.experiment.pages.form import Form
from seethrough.experiment.pages.pages import Choice, PlatePicture, Scale, TextField
from seethrough.experiment.people.participant import SimulatedParticipant
from seethrough.experiment.questions.depth_test.depth_pairs import RATIO, depth_test
from seethrough.experiment.questions.kit import Asking
from seethrough.experiment.questions.tlx.tlx_question import TLX
from seethrough.experiment.session import questionnaire
from seethrough.experiment.session.questionnaire import Said
from seethrough.experiment.study.config import find, load, parse
from seethrough.experiment.study.shown.described import design_entry
from seethrough.experiment.study.tables.ready import READY, question
from seethrough.renderer.techniques.dynamic.dynamic_transparency import DynamicTransparency

PUBLISHED = load("published")
BUILDING = PUBLISHED.parameters("world", "building")


class Answers:
    """Answers every page by rule and keeps the pages."""

    def __init__(self, **fixed):
        self.fixed, self.pages = fixed, []

    def ask(self, page):
        self.pages.append(page)
        answers = {"button": "0"}
        for block in page.blocks:
            if isinstance(block, Scale):
                answers[block.name] = str(block.steps - 1)
            elif isinstance(block, Choice):
                answers[block.name] = "1"
        given = {k: v.pop(0) if isinstance(v, list) else v for k, v in self.fixed.items()
                 if any(getattr(b, "name", None) == k for b in page.blocks)}  # fmt: skip
        return answers | given


def rows_of(steps, person, given=None):
    """All rows of a participant who is never interrupted."""
    return list(chain.from_iterable(questionnaire.asked(steps, person, given)))


def with_blocks(*names):
    """The published study with these pages at its end."""
    table = tomllib.loads(find("published").read_text("utf-8"))
    table["questions"] = {name: {} for name in names}
    return parse(table, "s")


def test_the_published_session_asks_for_consent_age_gender_and_four_plates():
    person = Answers(age="27")
    rows = rows_of(questionnaire.before(PUBLISHED, 1), person)
    assert [r["item"] for r in rows] == [
        "consent", "age", "gender", *(f"color_plate_{n}" for n in (1, 2, 3, 4)),
    ]  # fmt: skip
    assert rows[1]["value"] == "27" and rows[2]["text"] == "male"


@pytest.mark.parametrize(
    ("text", "fine"),
    [("", True), (" ", True), ("0", True), (" 27 ", True), ("120", True), ("121", False),
     ("abc", False), ("-3", False), ("2.5", False), ("²", False), ("٣", False),
     ("9" * 5000, False)],
)  # fmt: skip
def test_a_field_for_an_age_takes_whole_numbers_of_years_or_nothing(text, fine):
    person = Answers(age="")
    rows_of(questionnaire.before(PUBLISHED, 1), person)
    (page,) = [p for p in person.pages if p.name == "demographics"]
    form = Form(page, {"age": text})
    assert form.complete == fine
    assert form.missing == (() if fine else ("age",))


def test_without_consent_nothing_else_is_asked():
    class Refuses(Answers):
        def ask(self, page):
            return super().ask(page) | {"button": "1"}

    person = Refuses()
    with pytest.raises(Leave):
        rows_of(questionnaire.before(PUBLISHED, 1), person)
    assert [p.name for p in person.pages] == ["consent"]


def test_plates_record_whether_the_digit_was_read():
    class Reads(Answers):
        def ask(self, page):
            answers = super().ask(page)
            for picture in page.blocks:
                if isinstance(picture, PlatePicture):
                    options = page.blocks[1].options
                    answers["digit"] = str(options.index(str(picture.plate.digit)))
            return answers

    def values(person):
        rows = rows_of(questionnaire.before(PUBLISHED, 1), person)
        return [r["value"] for r in rows if r["item"].startswith("color")]

    assert values(Reads()) == ["1"] * 4
    assert values(Answers(digit="6")) == ["0"] * 4  # "none"


def test_each_condition_is_rated_on_three_scales():
    rows = rows_of(questionnaire.after(with_blocks("ratings"), 1), Answers())
    assert len(rows) == 12
    rated = [{k: r[k] for k in ("transparency", "scenario")} for r in rows[::3]]
    assert rated == list(PUBLISHED.plan.conditions())


ALL = ("ratings", "comparison", "tlx", "sus", "depth_test", "remarks")


def test_a_pages_rows_are_out_before_the_next_page_is_shown():
    person = Answers(age="27", remarks="fine")
    steps = chain(questionnaire.before(PUBLISHED, 1), questionnaire.after(with_blocks(*ALL), 1))
    for number, rows in enumerate(questionnaire.asked(steps, person), start=1):
        assert len(person.pages) == number
        assert rows


@pytest.mark.parametrize("seed", range(5))
def test_what_was_answered_is_not_asked_again_wherever_it_broke_off(seed):
    def steps():
        after = questionnaire.after(with_blocks(*ALL), 1)
        return chain(questionnaire.before(PUBLISHED, 1), after)

    whole = Answers(age="27", remarks="fine")
    rows = rows_of(steps(), whole)
    # Page by page as a rule; after a power failure perhaps in the middle of a page.
    cut = int(np.random.default_rng(seed).integers(1, len(rows)))
    given = {questionnaire.item_of(row): questionnaire.said_in(row) for row in rows[:cut]}
    person = Answers(age="28", remarks="fine")
    assert rows[:cut] + rows_of(steps(), person, given) == rows
    assert len(person.pages) < len(whole.pages)


@pytest.mark.parametrize(
    ("option", "value", "text"),
    [("0", "1", "dynamic"), ("1", "0", "neutral"), ("2", "0", "standard")],
)
def test_preference_is_1_for_dynamic_and_0_else_and_says_which(option, value, text):
    rows = rows_of(questionnaire.after(with_blocks("comparison"), 1), Answers(preference=option))
    assert rows[0] == {"item": "preference", "value": value, "text": text}


def test_remarks_left_empty_leave_no_row():
    assert rows_of(questionnaire.after(with_blocks("remarks"), 1), Answers(remarks="")) == []
    (row,) = rows_of(questionnaire.after(with_blocks("remarks"), 1), Answers(remarks="<b>ok</b>"))
    assert row["text"] == "<b>ok</b>"


def sus_score(values):
    (part,) = READY["sus"].parts(Asking("sus"))
    items = {item: value for item, value in values.items() if item != "sus"}
    return question(part.kind).total(part.parameters, items)


def test_sus_scores_the_known_extremes_and_the_middle():
    def score(values):
        return sus_score({f"sus_{n}": str(v) for n, v in enumerate(values, start=1)})

    assert score([4, 0] * 5) == 100.0
    assert score([0, 4] * 5) == 0.0
    assert score([2] * 10) == 50.0
    # By hand: odd items 3 + 3 + 4 + 3 + 3 = 16, even ones 20 - (1 + 0 + 2 + 1 + 1) = 15.
    assert score([3, 1, 3, 0, 4, 2, 3, 1, 3, 1]) == 77.5


def test_a_score_that_a_power_failure_cut_off_counts_the_answers_that_were_kept():
    """Of ten statements four were on disk; the page is asked again, and those four stand."""
    kept = {
        (f"sus_{n}", (("transparency", "dynamic"),)): Said("4" if n % 2 else "0")
        for n in range(1, 5)
    }
    study = with_blocks("sus")
    rows = rows_of(questionnaire.after(study, 1), Answers(), dict(kept))
    mine = {r["item"]: r["value"] for r in rows if r["transparency"] == "dynamic"}
    assert set(mine) == {f"sus_{n}" for n in range(5, 11)} | {"sus"}
    both = {item: said.value for (item, *_), said in kept.items()} | mine
    assert float(mine["sus"]) == sus_score(both)
    new = {f"sus_{n}": mine["sus_5"] for n in range(1, 11)}
    assert float(mine["sus"]) != sus_score(new)


def test_tlx_has_six_scales_of_21_steps_for_each_level():
    rows = rows_of(questionnaire.after(with_blocks("tlx"), 1), Answers())
    assert len(rows) == 12 and {r["value"] for r in rows} == {"20"}
    assert {r["item"] for r in rows} == {f"tlx_{name}" for name in TLX}


def test_the_depth_test_asks_three_disjoint_clear_pairs_and_scores_them():
    test = depth_test(PUBLISHED.general.seed, "building", BUILDING)
    assert len(test.pairs) == 3 and len({k for pair in test.pairs for k in pair}) == 6
    scene, camera = test.view.scene, test.view.camera
    for (a, b), near in zip(test.pairs, test.nearer, strict=True):
        depths = []
        for kind in (a, b):
            at = [c for c, o in zip(scene.centers, scene.objects, strict=True) if o.kind == kind]
            # Only one of its kind is in view, and in front of the viewer.
            ahead = [camera.depth(c[None])[0] for c in at if _in_picture(camera, c)]
            assert len(ahead) == 1
            depths.append(ahead[0])
        assert depths[near] * RATIO <= depths[1 - near]
    right = {f"pair_{n}": str(near) for n, near in enumerate(test.nearer)}
    assert all(test.right(n, right) for n in range(3))
    assert not any(test.right(n, {k: str(1 - int(v)) for k, v in right.items()}) for n in range(3))
    rows = rows_of(questionnaire.after(with_blocks("depth_test"), 1), Answers(**right))
    assert [(r["item"], r["value"]) for r in rows] == [
        ("depth_pair_1", "1"), ("depth_pair_2", "1"), ("depth_pair_3", "1"), ("depth_test", "3"),
    ]  # fmt: skip


def _in_picture(camera, point):
    clip = camera.projection(4 / 3) @ camera.view() @ np.append(point, 1.0)
    return clip[3] > camera.near and abs(clip[0]) < clip[3] and abs(clip[1]) < clip[3]


def test_the_same_study_has_the_same_depth_test():
    one = depth_test(PUBLISHED.general.seed, "building", BUILDING)
    depth_test.cache_clear()
    two = depth_test(PUBLISHED.general.seed, "building", BUILDING)
    assert one.pairs == two.pairs and one.nearer == two.nearer


# Viénot, Brettel & Mollon 1999: what a deuteranope sees, in linear RGB.
DEUTAN = np.array([[0.29275, 0.70725, 0.0], [0.29275, 0.70725, 0.0], [-0.02234, 0.02234, 1.0]])


def test_the_plates_colours_are_alike_to_a_deuteranope_and_apart_to_others():
    figure, ground = (np.power(c, 2.2) for c in (FIGURE, GROUND))
    apart = np.linalg.norm(figure - ground)
    alike = np.linalg.norm(DEUTAN @ figure - DEUTAN @ ground)
    # The lightness of the dots varies by ± 25 %: the remaining difference must drown in it.
    assert alike < 0.25 * np.linalg.norm(DEUTAN @ ground) / 2
    assert apart > 8 * alike


def test_plates_are_four_digits_of_dots_that_do_not_overlap():
    made = plates(np.random.default_rng(3))
    assert len({p.digit for p in made}) == 4
    for plate in made:
        apart = np.linalg.norm(plate.places[:, None] - plate.places[None], axis=2)
        np.fill_diagonal(apart, np.inf)
        assert (apart > plate.radii[:, None] + plate.radii[None]).all()
        assert len(plate.places) > 150


def test_a_consent_file_that_is_missing_or_no_text_is_named(tmp_path):
    text = (
        '[study]\nname = "a"\ntitle = "a"\ndescription = "a"\nparticipants = 1\nseed = 1\n'
        '[technique]\nuse = "standard"\n[world]\nuse = "abstract"\n[design]\ntasks = ["count"]\n'
        '[questions]\nconsent = { file = "mine.txt" }\n'
    )
    study = tmp_path / "a.toml"
    study.write_text(text)
    with pytest.raises(InputError, match=r'a\.toml: questions\.consent\.file = "mine\.txt"'):
        load(str(study))
    (tmp_path / "mine.txt").write_bytes(b"\xff\xfe\xff")
    with pytest.raises(InputError, match="not UTF-8"):
        load(str(study))
    (tmp_path / "mine.txt").write_text("Grüße.\n")
    assert load(str(study)).texts["consent.text"] == "Grüße."


def test_optional_questions_do_not_hold_a_page_up():
    page = with_blocks("demographics")
    person = Answers()
    rows_of(questionnaire.before(page, 1), person)
    (asked,) = person.pages
    assert asked.required == ()
    assert isinstance(asked.blocks[0], TextField)


def test_simulated_participants_judge_the_depth_of_what_is_in_the_picture():
    test = depth_test(PUBLISHED.general.seed, "building", BUILDING)
    scores = []
    for seed in range(20):
        person = SimulatedParticipant(np.random.default_rng(seed))
        pages = enumerate(test.pages(DynamicTransparency()))
        scores.append(sum(test.right(n, person.answer(page)[0]) for n, page in pages))
    # Sixty fair coins come up right 42 times or more once in a thousand; the things that are out of
    # the picture, nearer ones of the same kinds among them, would bring it down to 20.
    assert sum(scores) >= 42


def test_weighted_workload_is_as_hart_and_staveland_add_it_up():
    """By hand: mental wins all of its 5 pairs, physical 4, …, frustration none, so the weights are
    5, 4, 3, 2, 1, 0, and of ratings 20, 15, 10, 5, 0, 20 the workload is 5 · (100 + 60 + 30 + 10) /
    15."""
    kind = question("tlx")
    p = kind.Parameters(weighted=True)
    ratings = dict(zip(TLX, (20, 15, 10, 5, 0, 20), strict=True))
    given = {f"tlx_{name}": str(value) for name, value in ratings.items()}
    for seed in (1, 2):
        asking = Asking("tlx", given=given, stream=lambda seed=seed: np.random.default_rng(seed))
        first, second = kind.pages(p, asking)
        assert [r["value"] for r in kind.rows(p, asking, 0, given)] == list(given.values())
        answers = {}
        for choice in second.asked:
            names = [option.removeprefix("tlx.factor.") for option in choice.options]
            answers[choice.name] = str(names.index(min(names, key=TLX.index)))
        rows = {r["item"]: r["value"] for r in kind.rows(p, asking, 1, answers)}
        assert [rows[f"tlx_weight_{name}"] for name in TLX] == list("543210")
        assert float(rows["tlx_weighted"]) == pytest.approx(5 * 200 / 15, rel=1e-9)
        assert len(second.asked) == 15 and [b.name for b in first.asked] == list(given)


def test_items_of_a_scale_come_page_by_page_shuffled_and_add_up():
    kind = question("likert")
    names = tuple(f"i{n}" for n in range(7))
    p = kind.Parameters(items=names, names=names, score="sum", per_page=3, shuffle=True, first=0)
    asking = Asking("x", stream=lambda: np.random.default_rng(3))
    pages = kind.pages(p, asking)
    shown = [b.name for page in pages for b in page.blocks if isinstance(b, Scale)]
    assert [len(page.asked) for page in pages] == [3, 3, 1] == [3, 3, kind.count(p) - 2]
    assert shown != list(names) and sorted(shown) == list(names)
    given = {}
    for number, page in enumerate(pages):
        now = Asking("x", given=given, stream=asking.stream)
        rows = kind.rows(p, now, number, {b.name: b.name[1] for b in page.asked
                                          if int(b.name[1]) < 5} | {b.name: "4" for b in page.asked
                                          if int(b.name[1]) >= 5})  # fmt: skip
        assert set(kind.last(p, now, number)) <= {r["item"] for r in rows}
        given |= {r["item"]: r["value"] for r in rows}
    assert float(given["sum"]) == 0 + 1 + 2 + 3 + 4 + 4 + 4


def test_ranks_belong_to_their_options_however_they_are_shown():
    kind = question("ranking")
    p = kind.Parameters(text="?", options=("a", "b", "c", "d"), shuffle=True)
    asking = Asking("x", stream=lambda: np.random.default_rng(5))
    (block,) = kind.blocks(p, asking)
    assert block.options != p.options
    wanted = {"a": "3", "b": "1", "c": "4", "d": "2"}
    answers = {"x": ",".join(wanted[option] for option in block.options)}
    rows = kind.rows(p, asking, 0, answers)
    assert [(r["item"], r["value"], r["text"]) for r in rows] == [
        (f"x_{n}", wanted[o], o) for n, o in enumerate("abcd", start=1)
    ]


def test_pairs_and_weights_are_not_what_a_report_compares():
    study = with_blocks("tlx")
    table = study.resolved()
    table["questions"] = [{"name": "tlx", "use": "tlx", "weighted": True}]
    items = {item["name"]: item["group"] for item in design_entry(parse(table, "s"))["items"]}
    assert items == {**{f"tlx_{name}": "tlx" for name in TLX}, "tlx_weighted": ""}
