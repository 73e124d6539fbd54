"""What a simulated participant is made of: every constant, its unit and its source, per profile.

Sources: KLM = Card, Moran & Newell, keystroke-level model; ACT-R/EMMA = code defaults of the
cognitive architecture and its eye-movement module; [ours] = chosen by us, a target of calibration.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import pi

from seethrough.renderer.meant import one_of


@dataclass(frozen=True)
class Profile:
    """Constants of a kind of person. Times in seconds, angles in radians, lengths in world units.

    Raises ValueError by name for a value nobody can have.
    """

    name: str = "average"

    # Eyes. ACT-R: a shift of attention 85 ms; EMMA: a saccade 20 ms + 2 ms per degree.
    attention_shift: float = 0.085
    saccade: float = 0.020
    saccade_per_degree: float = 0.002
    view_angle: float = 35.0  # degrees the view's height takes at a desk: 0.3 m at 0.5 m [ours]
    # Guided Search 6: 0 ms an item for pop-out, 25–30 ms and more for conjunctions and letters.
    search_slope: float = 0.030
    # A thing is noticed where contrast × √(window pixels) reaches this, half of the time [ours].
    notice: float = 0.6
    notice_spread: float = 0.5  # s.d. of the natural logarithm of that
    # A model's kind is told from 10 × 10 clear pixels half of the time [ours].
    recognise: float = 100.0
    recognise_spread: float = 0.7
    # Looks while on the move in a building: 1 at each 45° of a turn and at 2 or 3 places of a step,
    # some 2 a second; or so many times as many, or none. Data mode's lattice has those of 1 [ours].
    passing: int = 1
    crowding: float = 0.02  # nearer than this, in view heights, things run together (0.7°) [ours]
    crowded: float = 0.35  # how often one of two crowded things goes unnoticed [ours]

    # Counting. Trick & Pylyshyn 1994: 40–100 ms an item up to 4, then 250–350 ms.
    subitise: float = 0.070
    subitising_range: int = 4
    count: float = 0.300
    recheck: float = 0.250  # telling a thing as counted already, per item [ours]
    slip: float = 0.010  # an item lost or counted twice in passing [ours]

    # Hands. KLM: keystroke .20–.28, pointing 1.10, homing .40, mental preparation 1.35.
    key: float = 0.28
    point: float = 1.10
    home: float = 0.40
    prepare: float = 1.35
    # Turning things with the mouse: 4.09 bit/s (DeLong & MacKenzie 2018).
    bits_per_second: float = 4.09
    tolerance: float = pi / 12  # how well a turn must hit its aim [ours]
    motor_noise: float = 0.04  # s.d. of a turn's end, as a part of the turn [ours]
    gain: float = pi  # first guess of radians per view height; corrected by what is seen
    speed: float = 6.0  # first guess of walking speed; corrected by what is seen

    # Strategy [ours].
    orbit_step: float = pi / 3  # from one view of the abstract world to the next
    worth: float = 60.0  # seconds one would spend for one more thing of many
    diligence: float = 0.06  # share of the building that may stay unseen when counting
    certainty: float = 0.90  # posterior probability at which a letter is believed
    letter_looks: int = 8  # after so many looks, the best guess is good enough
    letter_turning: float = 1.0  # seconds to turn a letter half round in the mind (Cooper 1975)
    near_enough: float = 18.0  # how near one walks to see where something stands

    # Places. Distances in virtual worlds look short and uncertain (Loomis & Knapp 2003).
    depth_bias: float = 0.90
    depth_noise: float = 0.12  # s.d. as a part of the distance, of what is seen large and clear
    cloud_depth: float = 0.04  # the same in a world that one turns before the eyes [ours]
    drift: float = 0.10  # s.d. of where one believes to be, per root of the path length
    tracked: int = 4  # things kept in sight as the view moves (ACT-R: 4 FINSTs)
    plan_noise: float = 8.0  # s.d. of a mark on the plan

    # People. Egan: coefficient of variation of times about .4 between people.
    sd_person: float = 0.35  # s.d. of the logarithm of a person's pace
    sd_task: float = 0.30  # and of the same person's pace at each task
    sd_trial: float = 0.25  # and from trial to trial
    # Finding one's way: skill counts for less there than in the cloud, and luck for more [ours].
    sd_task_walking: float = 0.20  # as sd_task, in the building
    sd_trial_walking: float = 0.35  # as sd_trial, in the building
    sd_care: float = 0.30  # s.d. of the logarithm of a person's care
    pace: float = 1.0  # factor on all mental times
    care: float = 1.0  # factor on what a find is worth; slips and misses fall with it
    # Heathcote et al. 2000: practice follows an exponential in each person.
    learning: float = 0.35  # how much slower the first trial of a task is than the last
    learning_rate: float = 0.35  # per trial
    # Steinborn et al.: fatigue raises the variability of times, hardly their mean.
    fatigue: float = 0.25  # growth of sd_trial per hour

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name == "name":
                continue
            low, high = _LIMITS.get(field.name, (0, 1000))
            if not low <= value <= high:
                what = f"a number from {low:g} to {high:g}"
                raise ValueError(f"{field.name} = {value}, expected {what}")
            if isinstance(field.default, int) and value != int(value):
                raise ValueError(f"{field.name} = {value}, expected a whole number")
        for name in _SHARES:
            if getattr(self, name) > 1:
                raise ValueError(f"{name} = {getattr(self, name)}, expected a probability")
        for name in _POSITIVE:
            if getattr(self, name) == 0:
                raise ValueError(f"{name} = 0, expected a number > 0")
        if self.subitise > self.count:
            raise ValueError(
                f"subitise = {self.subitise}, expected at most count = {self.count}: "
                "a glance is no slower than counting"
            )

    @cached_property
    def eyes(self) -> tuple[float, float, float, float]:
        """What decides how well things are seen: people of the same eyes see the same."""
        return self.notice, self.notice_spread, self.recognise, self.recognise_spread


_SHARES = (
    "slip", "crowded", "diligence", "certainty",
)  # fmt: skip
_POSITIVE = (
    "notice_spread", "recognise", "recognise_spread", "bits_per_second", "tolerance", "gain",
    "speed", "orbit_step", "pace", "care", "view_angle", "notice", "depth_bias", "point", "key",
)  # fmt: skip
_SPREADS = (
    "sd_person", "sd_task", "sd_trial", "sd_care", "sd_task_walking", "sd_trial_walking",
)  # fmt: skip
# Beyond these nobody is: e³ is twenty times another person, and half a circle is the largest turn.
_LIMITS = {
    **dict.fromkeys(_SPREADS, (0, 3)),
    **dict.fromkeys(("pace", "care"), (0, 20)),
    **dict.fromkeys(("orbit_step", "tolerance"), (0, pi)),
    **dict.fromkeys(("subitising_range", "letter_looks"), (1, 100)),
    "passing": (0, 10),
    "view_angle": (0, 179),
    "depth_bias": (0, 3),
    "motor_noise": (0, 1),
}

AVERAGE = Profile()
# Speed is traded for accuracy by the criterion at which one answers (Wickelgren 1977): care and
# pace go together. The factors are ours, within what `sd_person` and `sd_care` say of people; so is
# that novices have twice the average way to go in practice and unsteadier hands.
PROFILES: Mapping[str, Profile] = {
    "average": AVERAGE,
    "careful": replace(AVERAGE, name="careful", care=1.6, pace=1.15, diligence=0.02),
    "hasty": replace(AVERAGE, name="hasty", care=0.6, pace=0.85, diligence=0.15, certainty=0.75),
    "novice": replace(AVERAGE, name="novice", pace=1.2, learning=0.8, motor_noise=0.12),
}


def profile(name: str) -> Profile:
    """The profile of that name. Raises ValueError that lists the names there are."""
    if name not in PROFILES:
        raise ValueError(f"profile = {name}: expected {one_of(name, PROFILES)}")
    return PROFILES[name]
