"""docs/calibration.md is what the shipped profile's file says, and counts what its numbers say."""

import re
from pathlib import Path

from seethrough.benchmarks.sessions import calibrated
from seethrough.experiment.people.fitted.calibration import published
from seethrough.experiment.people.fitted.priors import FREE, SOURCED, intervals
from seethrough.experiment.people.persons.profile_file import find, made_by
from seethrough.tasks.kit.skills.profile import AVERAGE

DOCS = Path(__file__).parents[3] / "docs"
NUMBER = r"[-+]?\d+\.\d+"


def test_the_page_is_made_from_the_profile(tmp_path):
    out = tmp_path / "page.md"
    assert calibrated.main(["--out", str(out)]) == 0
    made = "run `python -m seethrough.benchmarks.sessions.calibrated --out docs/calibration.md`"
    assert out.read_text("utf-8") == (DOCS / "calibration.md").read_text("utf-8"), made


def test_rows_count_as_met_by_their_own_numbers():
    """A row off by 2.0 as printed may be either; of all others the verdict follows. Differences are
    counted by themselves."""
    fitted = [m for (t, _), m in published().items() if t in ("count", "count_in_building")]
    text = "\n".join(calibrated.page("calibrated"))
    for part, of, count in (("", "rows", sum(len(m.values()) for m in fitted)),
                            ("differences", "differences", len(fitted))):  # fmt: skip
        rows = [line for line in made_by("calibrated", part)[1] if "fitted: " in line]
        assert len(rows) == count
        for line in rows:
            off = abs(float(re.findall(NUMBER, line)[2]))
            if off != 2.0:
                assert line.endswith("fitted: met") == (off < 2), line
        met = sum(line.endswith("fitted: met") for line in rows)
        assert f"\n{met} of {count} fitted {of} are met.\n" in text


def test_what_the_page_says_of_reach_is_what_was_searched():
    """It says that each row alone is reached: in the table each is, by a count above none."""
    table = made_by("calibrated", "search")[1]
    tries = int(table[0].split()[0])
    rows = [re.search(rf"(\d+) of {tries}  (\w+) reach", line) for line in table[2:-1]]
    assert len(rows) == 20 and all(r and r[2] == "within" and int(r[1]) > 0 for r in rows)
    assert f" of {len(FREE) + len(SOURCED)} constants" in table[0]


def test_fitted_constants_lie_in_their_profile_intervals_and_those_within_their_limits():
    profile, within = find("calibrated"), intervals(AVERAGE)
    lines = made_by("calibrated", "intervals")[1][1:]
    assert [line.split()[0] for line in lines] == list(FREE)
    for line in lines:
        name, began, fitted, low, high, *_ = line.split()
        assert f"{getattr(profile, name):.3g}" == f"{float(fitted):.3g}"
        assert float(began) == float(f"{getattr(AVERAGE, name):.3g}")
        slack = 1 + 6e-3  # three digits are printed
        assert within[name].low / slack <= float(low) <= float(fitted) * slack
        assert float(fitted) / slack <= float(high) <= within[name].high * slack
