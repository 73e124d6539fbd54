"""Do the printed numbers fit each other? Each check is computed, none is typed in.

A finding says what was asked, whether it fits, and the numbers behind the answer.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from seethrough.analysis.page.numbers import bounded, fixed, p_value
from seethrough.analysis.published.grim import (
    fitting_scores,
    fitting_whole_numbers,
    mean_of_shares,
    totals,
)
from seethrough.analysis.published.numbers import Published, PublishedMeasure
from seethrough.analysis.published.reconstruct import r_interval, r_of
from seethrough.analysis.stats.distributions import f_tail
from seethrough.analysis.stats.multiplicity import holm

MOST_TRIALS = 12
MOST_WEIGHT = 12
SEARCHED_WEIGHT = 20


@dataclass(frozen=True, slots=True)
class Finding:
    """One check. `fits`: yes, no, or a word where the question is another one."""

    key: str
    question: str
    fits: str
    detail: str


def all_findings(published: Published) -> list[Finding]:
    """Every check, in the order of the paper."""
    return [
        *(p_finding(published, m) for m in published.measures),
        *(r_finding(published, m) for m in published.measures),
        overall_finding(published),
        *combined_findings(published),
        *grim_correct_findings(published),
        *grim_single_findings(published),
        grim_rating_finding(published),
        multiplicity_finding(published),
    ]


def p_finding(published: Published, m: PublishedMeasure) -> Finding:
    """Does the printed p follow from the printed F?"""
    df2 = published.participants - 1
    low, high = f_tail(m.f.high, 1, df2), f_tail(m.f.low, 1, df2)
    p = f_tail(m.f.value, 1, df2)
    return Finding(
        f"p_{m.name}",
        f"{m.label}: does p follow from F?",
        "yes" if m.p.allows(low, high) else "no",
        f"F(1, {df2}) = {m.f.text} gives p = {p:.6f} (rounded F: {low:.6f} to {high:.6f}); "
        f"printed: p {'' if m.p.bound else '= '}{m.p.text}",
    )


def r_finding(published: Published, m: PublishedMeasure) -> Finding:
    """Is the correlation that F implies possible?"""
    r = r_of(m, published.participants)
    low, high = r_interval(m, published.participants)
    possible = low <= 1 and high >= -1
    assumed = "; with an assumed SD (the scan is unreadable)" if m.dynamic.assumed else ""
    return Finding(
        f"r_{m.name}",
        f"{m.label}: is there a correlation that gives F?",
        "yes" if possible else "no",
        f"r = {bounded(r, 3)}, from {bounded(low, 3)} to {bounded(high, 3)} "
        f"with what rounding allows{assumed}",
    )


def overall_finding(published: Published) -> Finding:
    """Are the overall times some mean of the four tasks' times?"""
    parts = [published.measure(name) for name in published.tasks]
    whole = published.measure("time_overall")
    plain = [
        float(np.mean([getattr(m, level).mean.value for m in parts]))
        for level in ("standard", "dynamic")
    ]
    slack = [
        np.mean([getattr(m, level).mean.half for m in parts]) + getattr(whole, level).mean.half
        for level in ("standard", "dynamic")
    ]
    printed = (whole.standard.mean.value, whole.dynamic.mean.value)
    fits = all(abs(a - b) <= s for a, b, s in zip(plain, printed, slack, strict=True))
    small = weights(published, MOST_WEIGHT)
    larger = weights(published, SEARCHED_WEIGHT)
    said = f"none up to {MOST_WEIGHT}" if not small else _ratio(small[0])
    more = f"; up to {SEARCHED_WEIGHT}: {', '.join(map(_ratio, larger[:3])) or 'none'}"
    return Finding(
        "overall_time",
        "Are the overall times the mean of the four tasks' times?",
        "yes" if fits else "no",
        f"the tasks' plain means are {fixed(plain[0], 2)} and {fixed(plain[1], 2)}, printed are "
        f"{whole.standard.mean.text} and {whole.dynamic.mean.text}; "
        f"whole-number task weights that give both: {said}{more}",
    )


def weights(published: Published, most: int) -> list[tuple[int, ...]]:
    """Whole-number weights of the tasks, 1..most, that give both overall times (rounding allowed).

    Multiples of a smaller solution are left out.
    """
    parts = [published.measure(name) for name in published.tasks]
    whole = published.measure("time_overall")
    grid = np.stack(
        np.meshgrid(*[np.arange(1, most + 1)] * len(parts), indexing="ij"), axis=-1
    ).reshape(-1, len(parts))
    good = np.ones(len(grid), dtype=bool)
    for level in ("standard", "dynamic"):
        target = getattr(whole, level).mean
        lows = np.array([getattr(m, level).mean.low for m in parts])
        highs = np.array([getattr(m, level).mean.high for m in parts])
        total = grid.sum(axis=1)
        good &= (grid @ highs / total >= target.low) & (grid @ lows / total <= target.high)
    found = grid[good]
    simple = found[np.gcd.reduce(found, axis=1) == 1] if len(found) else found
    return [tuple(int(v) for v in row) for row in simple]


def _ratio(row: tuple[int, ...]) -> str:
    return " : ".join(map(str, row))


def combined_findings(published: Published) -> list[Finding]:
    """Is the combined error a mean of T1's and T4's? Means, weights, and the largest s.d."""
    t1, t4 = published.measure("error_T1"), published.measure("error_T4")
    both = published.measure("error_T1_T4")
    intervals, plain = [], []
    for level in ("standard", "dynamic"):
        a, b, c = (getattr(m, level).mean for m in (t1, t4, both))
        plain.append((a.value + b.value) / 2)
        ends = [
            (x - y) / (z - y)
            for x, y, z in itertools.product((c.low, c.high), (a.low, a.high), (b.low, b.high))
        ]
        intervals.append((min(ends), max(ends)))
    (l1, h1), (l2, h2) = intervals
    largest = (t1.standard.sd.high + t4.standard.sd.high) / 2
    shown = ", ".join(f"{bounded(a, 2)} to {bounded(b, 2)}" for a, b in intervals)
    same = max(l1, l2) <= min(h1, h2)
    means_fit = both.standard.mean.fits(plain[0]) and both.dynamic.mean.fits(plain[1])
    return [
        Finding(
            "combined_error_mean",
            "Is the combined error (T1 + T4) the plain mean of the two?",
            "yes" if means_fit else "no",
            f"the plain means are {bounded(plain[0], 4)} and {bounded(plain[1], 4)}, printed are "
            f"{bounded(both.standard.mean.value, 3)} and {bounded(both.dynamic.mean.value, 3)}",
        ),
        Finding(
            "combined_error_weights",
            "Does one weight of T4 give both combined errors?",
            "yes" if same else "no",
            f"standard and dynamic imply weights of T4 from {shown}{'' if same else ': disjoint'}",
        ),
        Finding(
            "combined_error_sd",
            "Can a plain mean of T1 and T4 have the combined SD?",
            "yes" if both.standard.sd.low <= largest else "no",
            f"it is at most {bounded(largest, 3)} (at r = 1); printed is "
            f"{bounded(both.standard.sd.value, 3)}",
        ),
    ]


def grim_correct_findings(published: Published) -> list[Finding]:
    """Shares of right answers in T2: GRIM at the stated trials, then with means and s.d."""
    n, per, moments = published.participants, published.per_cell, published.correct[0]
    count = n * per
    below = int(np.floor(moments.mean.value * count))
    near = " and ".join(f"{k}/{count} = {bounded(k / count, 3)}" for k in (below, below + 1))
    possible = bool(totals(moments, count, 1))
    mixed = mean_of_shares(moments, n, (1, 2, 3, 4))
    fits = {
        t: [fitting_scores(m, n, t) for m in published.correct] for t in range(1, MOST_TRIALS + 1)
    }
    both = [t for t, (a, b) in fits.items() if a and b]
    first = fits[both[0]] if both else [[], []]
    shown = "; ".join(
        f"{level}: errors of {' and '.join(f'{e}/{both[0]}' for e in errors[0])}"
        for level, errors in zip(("standard", "dynamic"), first, strict=True)
        if errors
    )
    return [
        Finding(
            "grim_correct",
            f"T2: can {count} answers have a share of {bounded(moments.mean.value, 3)} right?",
            "yes" if possible else "no",
            f"the nearest shares are {near}",
        ),
        Finding(
            "grim_correct_mixed",
            "T2: could participants with 1 to 4 trials each, mixed, have this mean?",
            "no" if mixed is None else "yes",
            "no mean of such shares prints so" if mixed is None else f"a mean of {mixed} would",
        ),
        Finding(
            "grimmer_correct",
            f"T2: how many trials each, up to {MOST_TRIALS}, give both means and SD?",
            "yes" if per in both else "no",
            f"{' or '.join(map(str, both)) or 'none'}, not {per}; {shown}",
        ),
        _rounding_finding(published, both),
        _people_finding(published),
    ]


def _rounding_finding(published: Published, both: Sequence[int]) -> Finding:
    """Do the fitting numbers of trials fit only because a half was rounded up?"""
    left = [
        t
        for t in both
        if all(
            fitting_scores(m, published.participants, t, halves=False) for m in published.correct
        )
    ]
    lost = [t for t in both if t not in left]
    rests = bool(lost)
    n = published.participants
    halves = {totals(m, n * t, 1)[0] / (n * t) for m in published.correct for t in lost}
    said = " and ".join(f"{h:.6g}"[1:] for h in sorted(halves))
    return Finding(
        "grimmer_correct_rounding",
        "T2: do those trials fit whichever way halves were rounded?",
        "no" if rests else "yes",
        f"{' and '.join(map(str, lost))} fit only if {said} was printed as "
        f"{bounded(published.correct[0].mean.value, 3)}, a half rounded up; rounded to even, "
        f"{' or '.join(map(str, left)) or 'none'} up to {MOST_TRIALS} fit"
        if rests
        else "no share lies on a half",
    )


def _people_finding(published: Published) -> Finding:
    """Would the answers of fewer participants have the printed means, and the SD too?"""
    per = published.per_cell
    means, whole = [], []
    for people in range(published.participants - 1, 1, -1):
        shares = [totals(m, people * per, 1) for m in published.correct]
        if all(shares):
            means.append(f"{people} × {per} answers ({shares[0][-1]}/{people * per})")
            if all(fitting_scores(m, people, per) for m in published.correct):
                whole.append(str(people))
    return Finding(
        "grim_correct_people",
        f"T2: would fewer participants, {per} trials each, have both means?",
        "yes" if not means else "the means, not the SD" if not whole else "they would",
        f"{', '.join(means)}; SD as well: {' or '.join(whole) or 'none'}"
        if means
        else "no smaller number would",
    )


def grim_single_findings(published: Published) -> list[Finding]:
    """Items asked once, on whole-number scales."""
    found = []
    for item in published.single:
        answers = fitting_whole_numbers(item.moments, published.participants, item.highest)
        shown = _counted(answers) if answers else "no answers have this mean and SD"
        found.append(
            Finding(
                f"grim_{item.name}",
                f"{item.label}: can whole answers have M = {item.moments.mean.text}, "
                f"SD = {item.moments.sd.text}?",
                "yes" if answers else "no",
                shown,
            )
        )
    return found


def _counted(answers: tuple[int, ...]) -> str:
    values = sorted(set(answers), reverse=True)
    return "for example " + ", ".join(f"{answers.count(v)} × {v}" for v in values)


def grim_rating_finding(published: Published) -> Finding:
    """The overall ratings: means over the items of whole answers."""
    per, highest = published.rating_items, published.rating_highest
    fits = [
        fitting_whole_numbers(m, published.participants, per * highest, per)
        for m in published.rating
    ]
    shown = [
        f"M = {m.mean.text} (SD = {m.sd.text}): {'possible' if f else 'impossible'}"
        for m, f in zip(published.rating, fits, strict=True)
    ]
    return Finding(
        "grim_rating",
        f"Overall rating: can means of {per} ratings from 0 to {highest} be as printed?",
        "yes" if all(fits) else "no",
        "; ".join(shown),
    )


def multiplicity_finding(published: Published) -> Finding:
    """Do the four tasks' time differences survive a correction for being four?"""
    df2 = published.participants - 1
    tasks = [published.measure(name) for name in published.tasks]
    raw = [f_tail(m.f.value, 1, df2) for m in tasks]
    corrected = holm(raw).tolist()
    bonferroni = [min(1.0, p * len(raw)) for p in raw]
    lost = [m.label for m, p in zip(tasks, bonferroni, strict=True) if p >= 0.05]
    shown = "; ".join(
        f"{m.label}: Holm {p_value(h)}, Bonferroni {p_value(b)}"
        for m, h, b in zip(tasks, corrected, bonferroni, strict=True)
    )
    survive = "all four survive Holm" if max(corrected) < 0.05 else "not all survive Holm"
    also = f", {' and '.join(lost)} do not survive Bonferroni" if lost else " and Bonferroni"
    return Finding(
        "multiplicity",
        "Four tasks: do the differences in time survive a correction?",
        "Holm" if max(corrected) < 0.05 and lost else "yes" if not lost else "no",
        f"{survive}{also}: {shown}",
    )
