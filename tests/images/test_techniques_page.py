"""docs/techniques.md is what it is made from, and what is measured there can come out otherwise."""

from __future__ import annotations

from seethrough import registry
from seethrough.experiment.suites.requirements import asked, measure
from seethrough.experiment.suites.techniques_page import REFERENCE, page
from seethrough.renderer.techniques import base


def test_the_reference_is_up_to_date():
    """`python -m seethrough.experiment.suites.techniques_page` writes it."""
    assert REFERENCE.read_text("utf-8") == page()


def test_what_the_paper_promises_of_its_own_technique_is_found():
    """Elmqvist2009 §III: every target shows, wherever it stands, and the standard one shows none
    of those that something hides."""
    dynamic = measure(registry.get("technique", "dynamic"))
    assert dynamic.found == dynamic.hidden > 0 and dynamic.alone
    standard = measure(registry.get("technique", "standard"))
    assert (standard.found, standard.layers) == (0, 0)
    assert (standard.kept, standard.context) == (1.0, 1.0)


def test_layers_of_constant_opacity_hide_as_the_product_says():
    """Each pane has one front surface of opacity .3: .7⁸ = .058 shows, .7¹⁶ = .003 does not."""
    assert 0.7**8 > 0.05 > 0.7**16
    assert measure(registry.get("technique", "constant")).layers == 8


def test_targets_in_line_are_what_breakaway_misses():
    """One ball stands before another from two of the sides."""
    found = measure(registry.get("technique", "breakaway"))
    assert found.found < found.hidden and found.least == 0.0


def test_a_technique_that_raises_is_a_finding():
    class Broken(type(registry.get("technique", "standard"))):
        def rule(self, p, state, seen, known):
            raise RuntimeError("not today")

    class Parameters(base.Parameters):
        pass

    broken = Broken.__new__(Broken)
    Parameters.technique = broken
    broken.Parameters = Parameters
    found = asked(broken)
    assert not found.holds and "not today" in found.said
