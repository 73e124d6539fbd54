"""What a ledger knows of its study, and how to tell two studies apart."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from seethrough.experiment.ledger.ledger_slots import Places

if TYPE_CHECKING:
    from seethrough.experiment.study.config import Study


@dataclass(frozen=True, slots=True)
class Plan:
    """The study's name, digest and config; rows of the design, target number, seconds to stale."""

    study: str
    digest: str
    rows: int
    participants: int
    stale_after: float
    resolved: Mapping[str, Any]  # as JSON has it

    @property
    def groups(self) -> tuple[Places, ...]:
        """The groups of the study; one where nobody is grouped."""
        said = self.resolved.get("groups")
        if not said:
            return (Places(self.rows, self.participants),)
        return tuple(
            Places(g["rows"], g["people"], dict(g["levels"]), dict(g["measured"])) for g in said
        )


def plan_of(study: Study) -> Plan:
    """The plan of a study's config."""
    table, stale_after, design = study.general, study.session.stale_after, study.plan
    digest, resolved = study.digest(), study.resolved()
    if len(design.groups) > 1:
        resolved["groups"] = [
            {
                "rows": design.rows(which), "people": group.people,
                "levels": dict(group.levels), "measured": dict(group.measured),
            }
            for which, group in enumerate(design.groups)
        ]  # fmt: skip
    return Plan(table.name, digest, design.rows(0), table.participants, stale_after, resolved)


def difference(known: Plan, plan: Plan) -> str:
    """Which key of the config is not as it was when the ledger began."""
    old, new = _flat(known.resolved), _flat(plan.resolved)
    key = next((k for k in sorted(old | new) if old.get(k) != new.get(k)), "study")
    return (
        f"{key} = {json.dumps(new.get(key))}: expected {json.dumps(old.get(key))}, as in the study "
        f"that this ledger began with ({known.digest[:12]}); choose another folder with --data"
    )


def _flat(table: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    flat: dict[str, object] = {}
    for key, value in table.items():
        if isinstance(value, Mapping):
            flat |= _flat(value, f"{prefix}{key}.")
        else:
            flat[prefix + key] = value
    return flat
