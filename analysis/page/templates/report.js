"use strict";
// Charts take the place of their drawings and say their numbers at the pointer. For the keyboard a
// chart is one stop of the Tab key; arrow keys, Home and End go from mark to mark inside it.
(() => {
  const steps = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, Home: -Infinity, End: Infinity };
  const options = {
    mode: "vega-lite", renderer: "svg", actions: false, hover: false,
    tooltip: { disableDefaultStyle: true },
  };
  const point = (kind, mark) => {
    const box = mark.getBoundingClientRect();
    const place = { clientX: box.x + box.width / 2, clientY: box.y + box.height / 2, bubbles: true };
    mark.dispatchEvent(new PointerEvent(kind, place));
  };
  const reach = (chart) => {
    const marks = [...chart.querySelectorAll("path[role=graphics-symbol][aria-label]")];
    marks.forEach((mark, at) => {
      mark.setAttribute("tabindex", at ? "-1" : "0");
      mark.addEventListener("focus", () => point("pointermove", mark));
      mark.addEventListener("blur", () => point("pointerout", mark));
      mark.addEventListener("keydown", (e) => {
        if (e.key === "Escape") point("pointerout", mark);
        if (!(e.key in steps)) return;
        e.preventDefault();
        const next = marks[Math.max(0, Math.min(marks.length - 1, at + steps[e.key]))];
        mark.setAttribute("tabindex", "-1");
        next.setAttribute("tabindex", "0");
        next.focus();
      });
    });
  };
  const charts = [...document.querySelectorAll(".chart")].map((chart) =>
    vegaEmbed(chart, JSON.parse(chart.nextElementSibling.textContent), options).then(() => reach(chart)));
  Promise.all(charts).then(() => { document.documentElement.dataset.charts = "ready"; });
  addEventListener("beforeprint", () => {
    for (const fold of document.querySelectorAll("details")) fold.open = true;
  });
})();
