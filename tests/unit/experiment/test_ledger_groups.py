"""Groups of people in the ledger: quotas, and which group comes next."""

from datetime import UTC, datetime

import pytest
from hypothesis import given
from hypothesis import strategies as st

from seethrough.experiment.errors import InputError
from seethrough.experiment.ledger.ledger import Ledger
from seethrough.experiment.ledger.ledger_plan import Plan
from seethrough.experiment.ledger.ledger_slots import Places, next_slot, place_of

NOW = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)


@given(data=st.data(), people=st.integers(1, 8), groups=st.integers(2, 4), rows=st.integers(1, 4))
def test_assigned_groups_differ_by_at_most_one_and_fill_their_quotas(data, people, groups, rows):
    """People come, complete and drop out: as long as nobody drops out, groups are even; when all
    have come, each has exactly its quota."""
    places = [Places(rows, people, {"g": str(g)}) for g in range(groups)]
    live, done = set(), set()
    for _ in range(people * groups):
        slot = next_slot(live, done, places)
        live.add(slot)
        counts = [sum(place_of(s, groups)[0] == g for s in live | done) for g in range(groups)]
        assert max(counts) - min(counts) <= 1
        if data.draw(st.booleans()):
            live.remove(slot)
            done.add(slot)
    gone = set(data.draw(st.lists(st.sampled_from(sorted(live)), unique=True)) if live else [])
    live -= gone
    again = {next_slot_of(live, done, places) for _ in gone}
    assert again == gone
    done |= live
    assert [sum(place_of(s, groups)[0] == g for s in done) for g in range(groups)] == (
        [people] * groups
    )


def next_slot_of(live, done, places):
    """Reserve the next slot."""
    slot = next_slot(live, done, places)
    live.add(slot)
    return slot


def test_people_who_bring_a_level_along_get_a_place_of_their_group_or_none():
    places = [Places(2, 3, {"x": "novice"}, {"x": "novice"}), Places(2, 1, {"x": "expert"},
              {"x": "expert"})]  # fmt: skip
    assert next_slot((), (), places, {"x": "expert"}) == 2
    assert next_slot((2,), (), places, {"x": "expert"}) is None
    assert next_slot((2,), (), places, {"x": "novice"}) == 1
    assert next_slot((), (1, 2, 3, 5), places, {"x": "expert"}) == 4  # everybody came: whole rounds


def test_unequal_quotas_fill_in_proportion():
    places = [Places(1, 4), Places(1, 2)]
    live = set()
    order = [place_of(next_slot_of(live, (), places), 2)[0] for _ in range(6)]
    assert order == [0, 1, 0, 0, 1, 0]
    assert next_slot(live, (), places) is None


def test_many_stations_fill_groups_exactly(tmp_path):
    groups = [{"rows": 2, "people": n, "levels": {"g": str(n)}, "measured": {}} for n in (6, 3)]
    plan = Plan("test", "d", 4, 9, 3600.0, {"groups": groups})
    with Ledger.open(tmp_path, "", plan, NOW) as ledger:
        slots = [ledger.reserve(f"P{n}", NOW).slot for n in range(9)]
        with pytest.raises(InputError, match="every slot is complete or live"):
            ledger.reserve("Q", NOW)
    assert len(set(slots)) == 9
    assert [sum(place_of(s, 2)[0] == g for s in slots) for g in (0, 1)] == [6, 3]
    with Ledger.existing(tmp_path) as again:
        assert [g.people for g in again.plan.groups] == [6, 3]


def test_beyond_its_quota_a_group_has_places_only_once_every_group_has_all():
    groups = [Places(1, 1, {"age": age}, {"age": age}) for age in ("young", "old")]
    young = {"age": "young"}
    assert next_slot((), (), groups, young) == 1
    assert next_slot((), {1}, groups, young) is None  # nobody old has come yet
    assert next_slot({2}, {1}, groups, young) is None  # nor gone through with it
    assert next_slot((), {1, 2}, groups, young) == 3
    assert next_slot((), {1}, groups, {"age": "old"}) == 2
