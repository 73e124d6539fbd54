"""Wheel and second button, turned and pressed for real, move a lens in a window."""

import sys

from desktop import Desktop, Program, wait_until

# A view through a lens is shown until the wheel was turned thrice and the right button released.
SHOWN = """
from dataclasses import replace
from seethrough.experiment.commands.pictures.render import jeep
from seethrough.experiment.display.clock import RealClock
from seethrough.experiment.display.window import Window
from seethrough.experiment.pages.texts import Texts
from seethrough.experiment.session.hand import Hand
from seethrough.experiment.study.config import load
from seethrough.renderer.techniques import named
from seethrough.tasks.kit.base import View

window = Window(load("demo").display, Texts("en"), RealClock(), "lens")
scene, camera = jeep(1, 4 / 3)
lens = replace(named("lens"), depth=3.5, radius=0.3)
hand, view = Hand(lens, window.aspect), View(scene, camera)
window.begin_trial("count", False)
seen, digests, before = [], [], None
while not ("SecondRelease" in seen and seen.count("Wheel") >= 3):
    shown = hand.shown(view)
    window.show(shown, lens)
    if hand.state != before:
        before = hand.state
        digests.append(window.digest())
    for event in window.events(shown):
        kind = type(event).__name__
        hand.on_event(event, shown)
        if kind != "Tick":
            seen.append(kind)
    if not digests[1:]:
        print("ready", flush=True)
print("depth", round(hand.state.depth, 3), "pictures", len(set(digests)), "of", len(digests))
print(" ".join(dict.fromkeys(seen)))
window.close()
"""


def test_a_real_wheel_moves_the_lens(tmp_path):
    """Two steps away and one back: the depth is 1.1 times what it was, the picture others."""
    with Desktop() as desktop:
        start = (sys.executable, "-c", SHOWN)
        with Program(desktop, tmp_path / "log", start=start) as program:
            wait_until(lambda: "ready" in program.said(), 60, "the window")
            desktop.do("mousemove", "512", "400")
            for button in ("4", "4", "5", "3"):
                desktop.do("click", button)
            wait_until(lambda: "depth" in program.said(), 60, "the wheel")
            said = program.said()
    assert "depth 3.85 pictures" in said
    changed, states = said.partition("pictures ")[2].split()[0:3:2]
    assert int(changed) >= 2 and int(states) >= 3
    assert {"Wheel", "SecondPress", "SecondRelease", "PointerMove"} <= set(said.split())
