"""The parts of a simulated participant against closed forms and brute force."""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from seethrough.experiment.pages.pages import Choice, Page, Paragraph, Scale, TextField
from seethrough.experiment.people.forms import Opinions
from seethrough.experiment.people.persons import person
from seethrough.experiment.people.persons.person import Person
from seethrough.renderer.events import PointerMove
from seethrough.renderer.scene import geometry
from seethrough.renderer.scene.visibility import Visibility
from seethrough.tasks.catalog import TASKS
from seethrough.tasks.count_in_building.simulate import Tally
from seethrough.tasks.kit.letters import LETTERS, letter_points
from seethrough.tasks.kit.skills.counting import seconds_to_count, slips
from seethrough.tasks.kit.skills.effects import plan_effects
from seethrough.tasks.kit.skills.glance import likely, noticed, uncrowded
from seethrough.tasks.kit.skills.hands import Hands
from seethrough.tasks.kit.skills.mood import Mood
from seethrough.tasks.kit.skills.places import Known, apart, bearing, crossed, layout
from seethrough.tasks.kit.skills.profile import AVERAGE
from seethrough.tasks.kit.skills.strategy import Strategy
from seethrough.tasks.kit.skills.walking import REACH, Found, _nearby
from seethrough.tasks.pattern.simulate import (
    FAR,
    FIT,
    _fit,
    _templates,
    letter_chances,
)
from seethrough.tasks.worlds.building.building import unique_building
from seethrough.tasks.worlds.building.building_parameters import BuildingParameters


def mood(task="count", seed=1, without=(), care=1.0):
    effects = plan_effects(TASKS[task].simulate.effects, 0, frozenset(without))
    return Mood(np.random.default_rng(seed), AVERAGE, effects, 1.0, care)


def visibility(pixels, contrast, position=None):
    n = len(pixels)
    pixels, contrast = np.array(pixels), np.array(contrast, float)
    place = np.zeros((n, 2)) if position is None else np.array(position, float)
    return Visibility(pixels, (pixels > 0) * 1.0, place, contrast, pixels / 30_000)


def test_half_of_the_threshold_cases_get_through():
    assert_allclose(likely(np.array([1.2, 0.0]), 1.2, 0.5), [0.5, 0.0], atol=1e-12)
    # The logistic is within .01 of the normal integral: one spread above is Φ(1) = .841.
    assert_allclose(likely(np.array([1.2 * np.exp(0.5)]), 1.2, 0.5), [0.8413], atol=0.01)


def test_unseen_things_are_never_noticed_and_strong_ones_always():
    seen = visibility([0, 900, 1], [0.9, 0.9, 1e-6])
    for seed in range(50):
        assert noticed(seen, mood(seed=seed)).tolist() == [1]


def test_crowding_hides_the_weaker_of_close_neighbours():
    close = visibility([50, 80, 50], [0.5] * 3, [(0.5, 0.5), (0.51, 0.5), (0.9, 0.5)])
    lost = 0
    for seed in range(400):
        left, gone = uncrowded(close, np.arange(3), mood(seed=seed))
        assert {1, 2} <= set(left.tolist())
        lost += gone
    assert abs(lost / 400 - AVERAGE.crowded) < 4 * (0.35 * 0.65 / 400) ** 0.5
    free = mood(without=["crowding"])
    assert len(uncrowded(close, np.arange(3), free)[0]) == 3


def test_counting_times_add_up():
    """Four are taken in at a glance wherever they are; from the fifth on each is counted."""
    p, m = AVERAGE, mood()
    assert seconds_to_count(np.zeros((0, 2)), m) == 0
    for gap in (0.02, 0.2):
        line = np.array([[0.1 + gap * k, 0.1] for k in range(6)])
        step = p.saccade + p.saccade_per_degree * gap * p.view_angle
        for n in range(1, 5):
            assert_allclose(seconds_to_count(line[:n], m), p.attention_shift + n * p.subitise)
        four = seconds_to_count(line[:4], m)
        assert_allclose(seconds_to_count(line, m), four + 2 * (p.count + step))
        slow = mood(without=["subitising"])
        assert_allclose(seconds_to_count(line, slow), p.attention_shift + 6 * p.count + 5 * step)


def test_counting_is_as_quick_as_people_are():
    """Trick & Pylyshyn 1994: 40–120 ms for each of up to four, 250–350 ms for each further one."""
    places = np.random.default_rng(3).random((30, 2))
    seconds = [seconds_to_count(places[:n], mood()) for n in (1, 4, 5, 30)]
    assert 0.04 <= (seconds[1] - seconds[0]) / 3 <= 0.12
    assert 0.25 <= (seconds[3] - seconds[1]) / 26 <= 0.40  # with the way of the eyes


def test_slips_have_their_rate():
    total = [slips(1000, mood(seed=s)) for s in range(200)]
    # Twice the variance of a binomial of 1000 at 1 %: s.d. 4.45 a run, .31 for the mean.
    assert abs(np.mean(total)) < 5 * 0.315
    assert_allclose(np.std(total), 4.45, rtol=0.25)
    assert slips(1000, mood(without=["slips"])) == 0


def test_hands_turn_as_far_and_as_long_as_they_should():
    m = mood(without=["motor_noise"])
    hands = Hands(m, 5.0)
    hands.turn(np.pi / 3, 0.2, drag=True)
    moves = [e for e in hands.take() if isinstance(e, PointerMove)]
    assert_allclose(sum(e.dx for e in moves) * np.pi, -np.pi / 3)
    assert_allclose(sum(e.dy for e in moves) * np.pi, 0.2)
    bits = np.log2(np.hypot(np.pi / 3, 0.2) / (np.pi / 12) + 1)
    assert_allclose(hands.time - 5.0, bits / 4.09)
    assert moves[2].x != moves[0].x


@pytest.mark.parametrize("letter", sorted(LETTERS))
def test_clean_letters_are_told_apart_at_any_angle(letter):
    for angle in np.linspace(0, 6, 13):
        chances = letter_chances(letter_points(letter, 12.0, angle)[:, [0, 2]])
        assert max(chances, key=chances.get) == letter
        assert_allclose(sum(chances.values()), 1)


def test_a_letter_fits_as_well_as_its_best_angle_says():
    cones = np.random.default_rng(5).uniform(-1, 1, (9, 2))
    strokes = np.concatenate(
        [np.linspace((-0.6, -1), (0.6, 1), 9), np.linspace((0.6, -1), (-0.6, 1), 9)]
    )
    misfits = []
    for angle in np.arange(36) * np.pi / 18:
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        apart = [[min(((cone - s @ turn) ** 2).sum(), FAR**2) for s in strokes] for cone in cones]
        misfits.append(
            np.mean([min(row) for row in apart])
            + np.mean([min(column) for column in zip(*apart, strict=True)])
        )
    assert_allclose(_fit(_templates()["X"], cones), -min(misfits) * 9 / (2 * FIT**2), rtol=1e-12)


def test_a_handful_of_cones_says_nothing():
    assert set(letter_chances(np.zeros((3, 2))).values()) == {0.2}


numbers = st.integers(-6, 6)


@settings(max_examples=200, deadline=None)
@given(st.tuples(numbers, numbers), st.tuples(numbers, numbers), st.tuples(numbers, numbers),
       st.tuples(numbers, numbers))  # fmt: skip
def test_crossing_agrees_with_rational_arithmetic(eye, point, a, b):
    """Solved exactly: eye + s (point − eye) = a + t (b − a) with 0 < s < 1 and 0 ≤ t ≤ 1."""
    d = (point[0] - eye[0], point[1] - eye[1])
    e = (b[0] - a[0], b[1] - a[1])
    f = (a[0] - eye[0], a[1] - eye[1])
    det = Fraction(d[0] * e[1] - d[1] * e[0])
    expected = False
    if det:
        s = Fraction(f[0] * e[1] - f[1] * e[0]) / det
        t = Fraction(f[0] * d[1] - f[1] * d[0]) / det
        expected = 0 < s < 1 and 0 <= t <= 1
    found = crossed(np.array(eye, float), np.array([point], float), np.array([[a, b]], float))
    assert bool(found[0]) == expected


def test_bearings_and_angles():
    ways = np.array([[0.0, -1.0], [-1.0, 0.0], [0.0, 1.0], [1.0, 0.0]])
    assert_allclose(np.abs(bearing(ways)), [0, np.pi / 2, np.pi, np.pi / 2])
    assert bearing(ways)[1] > 0 > bearing(ways)[3]  # left of −z is −x
    assert_allclose(apart(3.0, -3.0), 6 - 2 * np.pi)
    assert_allclose(apart(0.5, 0.2), 0.3)


def test_known_walls_hide_cells_and_doorways_do_not():
    cube = geometry.box()
    models = {"a": lambda: cube, "b": lambda: cube}
    b = unique_building(np.random.default_rng(1), BuildingParameters(), models)
    whole = layout(b.scene)
    plan = whole.grid
    assert plan.size == 16 and len(plan.centers) == 256
    assert len(whole.segments) == 4 + 2 * len(b.floor.walls)
    known = Known(whole)
    eye = b.start
    assert_allclose(plan.centers[plan.cell(eye)], eye)
    rng = np.random.default_rng(3)
    for place in [*rng.uniform(-60, 60, (200, 2)), (-99.0, 99.0)]:  # outside as well: the nearest
        away = np.hypot(*(plan.centers - place).T)
        assert plan.cell(tuple(place)) == np.argmin(away)
    assert not known.hidden(plan.cell(eye)).any()  # no wall seen yet
    known.see_walls(range(len(b.scene.objects)))
    hidden = known.hidden(plan.cell(eye))  # the start is the middle of its cell
    # The oracle walks along each way in small steps and asks the floor plan for the walls passed.
    for cell, found in zip(plan.centers, hidden, strict=True):
        assert found == _blocked(b, eye, cell), cell


def _blocked(b, eye, cell):
    p = b.parameters
    steps = eye + np.linspace(0, 1, 4001)[1:-1, None] * (cell - eye)
    for wall in b.floor.walls:
        across, along = (1, 0) if wall.axis == 0 else (0, 1)
        side = steps[:, across] - wall.level
        for k in np.nonzero(side[:-1] * side[1:] <= 0)[0]:
            at = steps[k, along]
            inside = wall.start <= at <= wall.end
            if inside and not abs(at - wall.door) < p.door_width / 2:
                return True
    return False


class _Here:
    """As much of a walker as a tally needs: exact places."""

    def __init__(self, places):
        self.mood = mood("count_in_building", without=["depth_noise"])
        self.places, self.eye, self.error = places, (-10.0, 0.0), (0.0, 0.0)

    def place(self, index, clear):
        return self.places[index]


def _found(*index):
    return Found(dict.fromkeys(index, 400.0))


def test_things_are_told_by_their_places():
    places = {1: (0, 0), 2: (60, 0), 3: (61, 0), 4: (0, 1)}
    walker = _Here(places)
    tally = Tally(walker.mood)
    assert tally.add(walker, _found(1, 2)) == 2
    assert tally.add(walker, _found(1, 2)) == 0
    # Two in one look are two, however close; one that comes later and close is mistaken for it.
    assert tally.add(walker, _found(2, 3)) == 1
    assert tally.add(walker, _found(4)) == 0


LEVELS = ("dynamic", "", "standard")  # what the options of a comparison speak for


def cell(level):
    """What a page is about: a level of transparency in the building."""
    return (("transparency", level), ("scenario", "walkthrough"))


def test_pages_are_read_and_filled_in():
    opinions = Opinions(Person(np.random.default_rng(1), AVERAGE))
    for level, seconds in (("standard", 100.0), ("dynamic", 30.0)):
        text = Page("instruction", "t", (Paragraph("ready.text"),), about=cell(level))
        assert opinions.answer(text)[0] == {"button": "0"}
        for _ in range(3):
            opinions.begin("unique")
            opinions.spent("unique", seconds)
    ratings = {"standard": [], "dynamic": []}
    for level in ratings:
        page = Page("r", "r", (Scale("ease", "rating.ease", "l", "h"),), about=cell(level))
        for _ in range(40):
            answers, spent = opinions.answer(page)
            assert spent > 0 and 0 <= int(answers["ease"]) <= 4
            ratings[level].append(int(answers["ease"]))
    assert np.mean(ratings["dynamic"]) > np.mean(ratings["standard"]) + 1
    choice = Choice("preference", "p", ("a", "b", "c"), prefer=LEVELS)
    page = Page("c", "c", (choice, TextField("remarks", "t")))
    chosen = [opinions.answer(page)[0] for _ in range(50)]
    assert sum(a["preference"] == "0" for a in chosen) > 40
    assert all(a["remarks"] == "" for a in chosen)


def test_opinions_without_experience_are_neutral():
    opinions = Opinions(Person(np.random.default_rng(1), AVERAGE))
    page = Page("c", "c", (Choice("preference", "p", ("a", "b", "c"), prefer=LEVELS),))
    assert opinions.answer(page)[0]["preference"] == "1"


def test_load_and_negative_statements_are_rated_the_other_way():
    opinions = Opinions(Person(np.random.default_rng(1), AVERAGE))
    for level, seconds in (("standard", 100.0), ("dynamic", 25.0)):
        opinions.answer(Page("instruction", "t", about=cell(level)))
        opinions.begin("count")
        opinions.spent("count", seconds)
    means = {}
    for level in ("standard", "dynamic"):
        load = Scale("effort", "x", "l", "h", steps=21, against=True)
        tlx = Page("tlx", "t", (load,), about=(("transparency", level),))
        both = (Scale("sus_1", "x", "l", "h"), Scale("sus_2", "x", "l", "h", against=True))
        sus = Page("sus", "s", both, about=(("transparency", level),))
        answers = [opinions.answer(tlx)[0] | opinions.answer(sus)[0] for _ in range(40)]
        means[level] = {
            k: np.mean([int(a[k]) for a in answers]) for k in ("effort", "sus_1", "sus_2")
        }
    assert means["standard"]["effort"] > means["dynamic"]["effort"] + 3
    assert means["standard"]["sus_1"] < means["dynamic"]["sus_1"] - 0.5
    assert means["standard"]["sus_2"] > means["dynamic"]["sus_2"] + 0.5


def test_what_is_unseen_nearby_is_summed_over_a_square():
    b = unique_building(np.random.default_rng(1), BuildingParameters(), {
        "a": lambda: geometry.box(), "b": lambda: geometry.box(),
    })  # fmt: skip
    known = Known(layout(b.scene))
    known.inspect(np.random.default_rng(2).random(256))
    unseen = known.unseen.reshape(16, 16)
    expected = [
        unseen[max(0, i - REACH) : i + REACH + 1, max(0, j - REACH) : j + REACH + 1].sum()
        for i in range(16)
        for j in range(16)
    ]
    assert_allclose(_nearby(known.unseen, known.layout.grid.size), expected, rtol=1e-12)


def test_looks_from_one_place_do_not_add_up_and_from_two_they_do():
    b = unique_building(np.random.default_rng(1), BuildingParameters(), {
        "a": lambda: geometry.box(), "b": lambda: geometry.box(),
    })  # fmt: skip
    known = Known(layout(b.scene))
    for _ in range(3):
        known.inspect(np.full(256, 0.6))
    assert_allclose(known.left, 0.4)
    assert_allclose(known.gain(np.full(256, 0.9)), 0.3)
    known.move()
    known.inspect(np.full(256, 0.5))
    assert_allclose(known.left, 0.2)
    known.unclear[7] = 3  # something was noticed in cell 3 and not made out
    assert known.unseen[3] == 1.0
    known.doubt()
    assert_allclose(np.delete(known.unseen, 3), 0.5)


def test_paces_at_other_tasks_have_streams_of_their_own(monkeypatch):
    """A task that is added changes nobody's pace at any other, whatever is asked first."""
    other = SimpleNamespace(simulate=Strategy(lambda mood, glance: None))
    monkeypatch.setattr(person, "TASKS", {**TASKS, "nearer": other, "locate": other})
    first, second = (Person(np.random.default_rng(5), AVERAGE) for _ in range(2))
    assert first.pace == second.pace
    tasks = ("nearer", "locate")
    assert [first.pace_at(t) for t in tasks] == [second.pace_at(t) for t in reversed(tasks)][::-1]
    assert len({first.pace_at(t) for t in (*tasks, "count")}) == 3
