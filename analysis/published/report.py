"""`report --published`: the paper's analysis again, on data with its printed moments."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files

import numpy as np
from numpy.random import Generator

from seethrough.analysis.before import FACTORS, RATIOS
from seethrough.analysis.comparison import Pair, apa_f, compare
from seethrough.analysis.equivalence import Margin
from seethrough.analysis.figures.comparison import effect_sizes
from seethrough.analysis.page.blocks import Block, Column, Fold, Report, Section, Table, say
from seethrough.analysis.published.consistency import Finding, all_findings
from seethrough.analysis.published.numbers import Published, load_published
from seethrough.analysis.published.ordinal import Case, correct_cases, rating_cases
from seethrough.analysis.published.predictions import (
    equivalence_section,
    equivalence_table,
    predictions_section,
)
from seethrough.analysis.published.reconstruct import exact_moments, r_interval, r_of
from seethrough.analysis.sections.provenance import PAIRS, software

CONTRAST = FACTORS[0].contrasts()[0]
KINDS = {"time": "time", "error": "count_error", "distance": "distance"}
"""What a measure's margin is declared of, by the start of its name."""
FITTING_TRIALS = range(1, 13)

TITLE = "The published study of dynamic transparency, recomputed"
SUBTITLE = (
    "From the numbers that the paper prints (004, section VII): data with exactly these means, "
    "standard deviations and F, the ordinary analysis on them, and what does not fit."
)
BANNER = (
    "Reconstructed data: every F comes back by construction. The evidence is in the consistency "
    "checks."
)

COMPARED = (
    Column("measure", "measure"),
    Column("label", "measure"),
    Column("mean_standard", "M standard", "text", "as printed"),
    Column("sd_standard", "SD", "text", "as printed"),
    Column("mean_dynamic", "M dynamic", "text", "as printed"),
    Column("sd_dynamic", "SD", "text", "as printed"),
    Column("f_published", "F published", "text", "as printed"),
    Column("F", "F again", "fixed3", "by construction"),
    Column("p_published", "p published", "text", "as printed"),
    Column("p", "p again", "p"),
    Column("p_holm", "p (Holm)", "p", "four tasks"),
    Column("r", "r implied", "bound3", "what rounding allows", "r_low", "r_high"),
    Column("r_low", "r from", "bound3", "rounding"),
    Column("r_high", "r to", "bound3", "rounding"),
    Column("pes", "η²p", "bound2", "90 % interval", "pes_low", "pes_high"),
    Column("pes_low", "from", "bound2", "90 % interval"),
    Column("pes_high", "to", "bound2", "90 % interval"),
    Column("dz", "d_z", "fixed2", "95 % interval", "dz_low", "dz_high"),
    Column("dz_low", "d_z from", "fixed2", "95 % interval"),
    Column("dz_high", "d_z to", "fixed2", "95 % interval"),
)
CHECKS = (
    Column("check", "check"),
    Column("question", "question"),
    Column("fits", "fits?"),
    Column("detail", "what was found"),
)
CASES = (
    Column("case", "data"),
    Column("chi2", "χ²(1)", "fixed2"),
    Column("p", "p (χ²)", "p"),
    Column("p_exact", "p (sign test)", "p"),
    Column("p_published", "p published"),
    Column("agrees", "prints so?"),
)


def published_report(seed: int = 1) -> Report:
    """The whole report. Its numbers come from published.toml and nowhere else."""
    published = load_published()
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(3, 0)))
    measures = reconstructed(published, rng)
    tests = replace(
        compare(measures),
        key="tests_published",
        title="The ordinary analysis, in full",
    )
    compared = _compared(published, tests)
    findings = all_findings(published)
    equal = equivalence_table(published, tests)
    sections = (
        predictions_section(published, tests, findings, equal),
        _recomputed(published, tests, compared),
        _consistency(findings),
        _ordinal(published, rng),
        equivalence_section(published, tests, equal),
        _ran(seed),
    )
    return Report(TITLE, SUBTITLE, BANNER, sections)


def _ran(seed: int) -> Section:
    """Versions, the stream, and the hash of the numbers that all this comes from."""
    data = (files("seethrough.analysis.published") / "published.toml").read_bytes()
    rows = (
        *software(),
        {"what": "analysis stream", "value": f"seed {seed}, spawn key (3, 0)"},
        {"what": "published.toml, SHA-256", "value": hashlib.sha256(data).hexdigest()},
    )
    return Section("provenance", "What ran", (Table("ran", "What ran", PAIRS, rows),))


def reconstructed(published: Published, rng: Generator) -> list[Pair]:
    """Each printed measure as data with exactly its moments."""
    n = published.participants
    return [
        Pair(
            m.name,
            m.label,
            m.unit,
            2 if m.unit else 3,
            *exact_moments(n, m.standard, m.dynamic, r_of(m, n), rng),
            family="tasks" if m.name in published.tasks else "",
            margin=_margin(published, m.name),
            contrast=CONTRAST,
        )
        for m in published.measures
    ]


def _margin(published: Published, name: str) -> Margin | None:
    """What the study declares of a printed measure."""
    kind = KINDS[name.partition("_")[0]]
    value = published.margins.get(kind)
    return None if value is None else Margin(value, kind in RATIOS)


def _compared(published: Published, tests: Table) -> Table:
    rows = []
    for m in published.measures:
        own = tests.row(m.name)
        low, high = r_interval(m, published.participants)
        rows.append(
            {
                **{c.name: own.get(c.name) for c in COMPARED},
                "mean_standard": m.standard.mean.text,
                "sd_standard": m.standard.sd.text,
                "mean_dynamic": m.dynamic.mean.text,
                "sd_dynamic": m.dynamic.sd.text,
                "f_published": m.f.text,
                "p_published": m.p.text,
                "r_low": low,
                "r_high": high,
            }
        )
    shown = tuple("label f_published F p_published p p_holm r pes dz".split())
    note = "T3 distance: the scan of its second SD is unreadable, 8.78 is assumed."
    return Table("published", "Published beside recomputed", COMPARED, tuple(rows), shown, note)


def _recomputed(published: Published, tests: Table, compared: Table) -> Section:
    sentences = [
        say(
            f"{m.label[0].upper()}{m.label[1:]}: published M = {{}} (SD = {{}}) standard and {{}} "
            f"(SD = {{}}) dynamic, F = {{}}, p {'' if m.p.bound else '= '}{{}}; recomputed {{}}, "
            "d_z = {} [{}, {}].",
            *(
                compared.cite(m.name, column)
                for column in ("mean_standard", "sd_standard", "mean_dynamic", "sd_dynamic")
            ),
            compared.cite(m.name, "f_published"),
            compared.cite(m.name, "p_published"),
            apa_f(tests, m.name),
            tests.cite(m.name, "dz"),
            tests.cite(m.name, "dz_low"),
            tests.cite(m.name, "dz_high"),
        )
        for m in published.measures
    ]
    why = say(
        "With two conditions F = n·d² / (s₁² + s₂² − 2·r·s₁·s₂), so each printed row fixes the "
        "correlation r between the conditions. Data with these means, SD and r give F back by "
        "construction; that is no evidence. That every r lies in [−1, 1] and every printed p fits "
        "its F is.",
        kind="note",
    )
    figure = effect_sizes("effect_sizes", "Standardised differences d_z with 95 % intervals", tests)
    blocks: tuple[Block, ...] = (why, *sentences, compared, figure, Fold("All columns", (tests,)))
    return Section("recomputed", "Published and recomputed", blocks)


def _check_rows(findings: Sequence[Finding]) -> tuple[dict[str, object], ...]:
    return tuple(
        {"check": f.key, "question": f.question, "fits": f.fits, "detail": f.detail}
        for f in findings
    )


def _consistency(findings: list[Finding]) -> Section:
    """What does not fit first; then everything that was asked."""
    bad = [f for f in findings if f.fits != "yes"]
    shown = ("question", "fits", "detail")
    wrong = Table("inconsistent", "What does not fit", CHECKS, _check_rows(bad), shown)
    every = Table("consistency", "All checks", CHECKS, _check_rows(findings), shown)
    totals = Table(
        "consistency_counts",
        "Checks",
        (Column("what", "checks"), Column("count", "count", "int")),
        (
            {"what": "asked", "count": len(findings)},
            {"what": "fitting", "count": len(findings) - len(bad)},
            {"what": "not fitting", "count": len(bad)},
        ),
    )
    text = say(
        "Of {} checks {} fit and {} do not, or only in part.",
        totals.cite("asked", "count"),
        totals.cite("fitting", "count"),
        totals.cite("not fitting", "count"),
    )
    blocks: tuple[Block, ...] = (text, wrong, Fold("All checks", (every, totals)))
    return Section("consistency", "Do the printed numbers fit each other?", blocks)


def _ordinal(published: Published, rng: Generator) -> Section:
    """Friedman's tests on data that fit what is printed, or the proof that none does."""
    fitting = [(t, correct_cases(published, t, rng)) for t in FITTING_TRIALS]
    trials, cases = next(((t, c) for t, c in fitting if c), (0, []))
    blocks: list[Block] = []
    if published.per_cell not in [t for t, c in fitting if c]:
        blocks.append(
            say(
                f"T2: no answers of {published.participants} participants in "
                f"{published.per_cell} trials have the printed means and standard deviations "
                f"(see the checks); the smallest number of trials that allows them is {trials}, "
                "if halves were rounded up."
            )
        )
    if cases:
        title = f"T2 correct, {trials} trials each: who errs in both conditions?"
        blocks.append(_cases("friedman_t2", title, published.correct_p.text, cases))
        chi2 = [c for c in cases if c[2]]
        blocks.append(
            say(
                f"χ² gives the printed p = {published.correct_p.text} in {len(chi2)} of "
                f"{len(cases)} arrangements: when the participant who errs with dynamic "
                "transparency is one of those who also err without it. The exact sign test gives "
                "1.0 in all of them."
                if all(c[1].exact == 1.0 for c in cases)
                else f"χ² gives the printed p in {len(chi2)} of {len(cases)} arrangements."
            )
        )
    ratings = rating_cases(published, rng)
    if ratings:
        title = "Overall rating: data with the printed moments, the two ways to pair them"
        blocks.append(_cases("friedman_rating", title, published.rating_p.text, ratings))
    return Section("ordinal", "The Friedman tests", tuple(blocks))


def _cases(key: str, title: str, printed: str, cases: Sequence[Case]) -> Table:
    rows = tuple(
        {
            "case": who,
            "chi2": result.chi2,
            "p": result.p,
            "p_exact": result.exact,
            "p_published": printed,
            "agrees": "yes" if agrees else "no",
        }
        for who, result, agrees in cases
    )
    return Table(key, title, CASES, rows)
