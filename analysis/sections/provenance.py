"""What ran: versions, plan, files with their hashes, the chains' state."""

from __future__ import annotations

import platform
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version

from seethrough.analysis.load.chain import ChainState
from seethrough.analysis.load.plan import Plan, digest
from seethrough.analysis.load.seal import seal
from seethrough.analysis.load.study import Study, config_of
from seethrough.analysis.page.blocks import Block, Column, Fold, Section, Table, say
from seethrough.analysis.sections.base.context import Context

PACKAGES = ("seethrough", "numpy", "pandas", "scipy", "statsmodels", "vl-convert-python", "Jinja2")
PAIRS = (Column("what", "what"), Column("value", "value"))


def software() -> list[dict[str, str]]:
    """Versions of what made this report."""
    rows = [{"what": "Python", "value": platform.python_version()}]
    for name in PACKAGES:
        try:
            rows.append({"what": name, "value": version(name)})
        except PackageNotFoundError:
            rows.append({"what": name, "value": "not installed"})
    return rows


def provenance_section(context: Context) -> Section:
    """The last section of a study's report."""
    study = context.study
    sealed, files = seal(study.folder, study.source)
    configs = sorted({digest(config_of(s)) for s in study.sidecars.values() if config_of(s)})
    ran = [
        *software(),
        {"what": "analysis stream", "value": f"seed {context.seed}, spawn key (3, …)"},
        {"what": "source", "value": study.source},
        {"what": "config hash (12 of 64)", "value": ", ".join(configs) or "no config recorded"},
        {"what": "analysis plan", "value": _plan(context.plan)},
        {"what": "hash chains", "value": _chains(study.chains)},
        {"what": "seal", "value": f"{sealed} ({files} files; seethrough seal)"},
        *_recorded(study.sidecars.values()),
    ]
    blocks: list[Block] = [
        say(f"Hash chains: {_chains(study.chains)}.{_unknown(study)}"),
        *(say(f"{line}.") for line in study.repairs),
        say(f"Seal of everything recorded: {sealed}."),
        Table("ran", "What ran", PAIRS, tuple(ran)),
        Fold(f"The {len(study.files)} files read, with their SHA-256", (_files(context),)),
    ]
    return Section("provenance", "What ran", tuple(blocks))


def _plan(plan: Plan) -> str:
    frozen = "frozen" if plan.frozen is not None else "defaults"
    rules = ", ".join(plan.exclude) or "none"
    margins = ", ".join(f"{name} {value:g}" for name, value in plan.margins.items())
    return (
        f"{frozen}; alpha {plan.alpha:g}; exclusions: {rules}; tests: {', '.join(plan.tests)}; "
        f"declared margins: {margins or 'none'}; "
        f"{len(plan.deviations)} deviations"
    )


def _chains(chains: Sequence[ChainState]) -> str:
    """The chains' state in a sentence; a broken one never gets this far."""
    said = {
        "verified": "verified to the end of the session",
        "open": "verified as far as they go, of sessions that were never closed",
        "none": "without a chain, where later changes would not show",
    }
    states = [chain.state for chain in chains]
    counts = {state: states.count(state) for state in said}
    parts = [f"{count} {said[state]}" for state, count in counts.items() if count]
    chained = [chain.traces for chain in chains if chain.state != "none"]
    gone = chained.count(None)
    if chained:
        parts.append(f"{sum(count or 0 for count in chained)} traces as they were recorded")
    if gone:
        parts.append(f"{gone} without their traces, which are not in this folder")
    return f"of {len(states)} trial tables {'; '.join(parts)}"


def _unknown(study: Study) -> str:
    """What cannot be known of sessions without an end, and of participants without a ledger."""
    lines = []
    open_ = [c.file for c in study.chains if c.state == "open"]
    if open_:
        lines.append(
            f"Never closed: {', '.join(open_[:5])}{' …' if len(open_) > 5 else ''}: rows after "
            "their last and answers of theirs could have been removed or changed without a trace."
        )
    if study.source == "human":
        lines.append(study.ledger.said())
    return "".join(f" {line}" for line in lines)


def _recorded(sidecars: Iterable[Mapping[str, object]]) -> list[dict[str, str]]:
    """Versions and driver that the sessions ran with, each distinct value once."""
    seen: dict[str, set[str]] = {}
    for sidecar in sidecars:
        inner = sidecar.get("provenance")
        place = inner if isinstance(inner, Mapping) else sidecar
        for key in (
            "versions",
            "python",
            "system",
            "display",
            "seed",
            "simulation_seed",
            "profile",
        ):
            if place.get(key) is not None:
                seen.setdefault(key, set()).add(_flat(place[key]))
    return [
        {"what": f"recorded {key}", "value": " | ".join(sorted(values)[:3])}
        for key, values in seen.items()
    ]


def _flat(value: object) -> str:
    if isinstance(value, Mapping):
        return ", ".join(f"{k} {_flat(v)}" for k, v in sorted(value.items()))
    return str(value)


def _files(context: Context) -> Table:
    states = {c.file: c.state for c in context.study.chains}
    # a session's other tables are held by the end file, which the chain's last value holds
    states |= {
        name.replace("_trials_", "_questionnaire_"): "verified"
        for name, state in states.items()
        if state == "verified"
    }
    rows = tuple(
        {"file": f.name, "rows": f.rows, "sha256": f.sha256, "chain": states.get(f.name, "none")}
        for f in context.study.files
    )
    columns = (
        Column("file", "file"),
        Column("rows", "rows", "int"),
        Column("sha256", "SHA-256"),
        Column("chain", "chain"),
    )
    return Table("files", "Files read", columns, rows)
