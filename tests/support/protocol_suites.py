"""What every Display, Input and Recorder has to keep to: a suite each, for every implementation."""

from seethrough.experiment.pages.pages import Choice, Page, Paragraph, Scale
from seethrough.experiment.record.recorder import trial_row
from seethrough.renderer.events import KeyPress, Tick

PAGE = Page(
    "asked",
    "welcome.title",
    (
        Paragraph("welcome.text"),
        Scale("ease", "rating.ease", "rating.low", "rating.high"),
        Choice("gender", "demographics.gender", ("gender.female", "gender.male")),
    ),
)


def keeps_to_display(display, clock, views, technique):
    """Shows views at times that never go back, digests them alike, and says what it is."""
    assert 0.2 < display.aspect < 10
    last, digests = clock.now(), []
    for view in [*views, *views]:
        flip = display.show(view, technique)
        assert last <= flip <= clock.now()
        last = flip
        digests.append(display.digest())
    assert all(isinstance(digest, str) for digest in digests)
    half = len(views)
    assert digests[:half] == digests[half:], "one picture, two digests"
    assert not any(digests) or len(set(digests[:half])) == half, "two pictures, one digest"
    for fraction in (0.0, 0.5, 1.0):
        display.progress(fraction)
    said = display.describe()
    assert said and all(isinstance(v, str) for pair in said.items() for v in pair)
    assert dict(said) == dict(display.describe())


def keeps_to_input(person, clock, task, views, show):
    """Sends events in the order of time that end with a Tick, and fills in whole pages."""
    name = task.name
    show(views[0])
    person.begin_trial(name, False)
    last = clock.now()
    for _ in range(20):
        events = person.events(views[0])
        assert events and isinstance(events[-1], Tick)
        times = [event.time for event in events]
        assert times == sorted(times) and times[0] >= last - 1e-9
        assert times[-1] <= clock.now()
        last = times[-1]
        show(views[0])
    answers = person.ask(PAGE)
    assert set(PAGE.required) <= set(answers)
    assert answers["button"] == "0" and all(isinstance(a, str) for a in answers.values())
    assert 0 <= int(answers["ease"]) < 5 and int(answers["gender"]) in (0, 1)
    assert clock.now() >= last


def keeps_to_recorder(recorder, record, view, read):
    """A trial's row is there as soon as it has ended, an answer as soon as it was given, and a
    trial that is under way is nowhere. `read()` is (rows of trials, rows of answers)."""
    recorder.trial_begins(record.trial)
    recorder.frame(10.0, view, "d1")
    recorder.event(KeyPress(52.0, "enter"))
    recorder.event(Tick(52.25))
    assert read() == ([], [])
    recorder.trial_ends(record)
    (row,), none = read()
    expected = {k: v for k, v in trial_row(record).items() if v is not None}
    assert none == [] and {k: as_written(row[k]) for k in expected} == {
        k: as_written(v) for k, v in expected.items()
    }
    answers = [{"item": "ease", "value": "3", "transparency": "dynamic"}]
    answers.append({"item": "remarks", "value": "", "text": 'a "quoted",\ntext'})
    recorder.answers(answers)
    recorder.note(record.trial, "the phone rang")
    _, found = read()
    assert [row["item"] for row in found] == ["ease", "remarks"]
    assert found[0]["value"] == "3" and found[1]["text"] == answers[1]["text"]
    assert len({row["row_id"] for row in [row, *found]}) == 3
    recorder.close("left")
    again, _ = read()
    assert len(again) == 1, "closing wrote a row"


def as_written(value):
    """A cell as every table has it: numbers by their value, all else as text."""
    if isinstance(value, bool):
        return str(value).lower()
    try:
        return float(value)
    except ValueError:
        return str(value)
