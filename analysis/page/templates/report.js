"use strict";
// Marks in figures say their numbers: at the pointer, and beside the mark for the keyboard. A
// figure is one stop of the Tab key; arrow keys, Home and End go from mark to mark inside it.
(() => {
  const tip = document.getElementById("tip");
  const place = (x, y) => {
    const box = tip.getBoundingClientRect();
    const below = y + 18 + box.height <= innerHeight;
    tip.style.left = Math.max(4, Math.min(x + 14, innerWidth - box.width - 4)) + "px";
    tip.style.top = Math.max(4, below ? y + 18 : y - box.height - 10) + "px";
  };
  const say = (mark, x, y) => { tip.textContent = mark.dataset.tip; tip.hidden = false; place(x, y); };
  const hush = () => { tip.hidden = true; };
  const steps = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1, Home: -Infinity, End: Infinity };
  for (const picture of document.querySelectorAll("figure svg")) {
    const marks = [...picture.querySelectorAll(".mark")];
    marks.forEach((mark, at) => {
      mark.querySelector("title").remove(); // the browser's own tip would double ours
      mark.setAttribute("tabindex", at ? "-1" : "0");
      mark.setAttribute("role", "img");
      mark.setAttribute("aria-label", mark.dataset.tip);
      mark.addEventListener("pointermove", (e) => say(mark, e.clientX, e.clientY));
      mark.addEventListener("pointerleave", hush);
      mark.addEventListener("focus", () => {
        const box = mark.getBoundingClientRect();
        say(mark, box.right, box.top);
      });
      mark.addEventListener("blur", hush);
      mark.addEventListener("keydown", (e) => {
        if (!(e.key in steps)) return;
        e.preventDefault();
        const next = marks[Math.max(0, Math.min(marks.length - 1, at + steps[e.key]))];
        mark.setAttribute("tabindex", "-1");
        next.setAttribute("tabindex", "0");
        next.focus();
      });
    });
  }
  document.addEventListener("keydown", (e) => { if (e.key === "Escape") hush(); });
  addEventListener("beforeprint", () => {
    for (const fold of document.querySelectorAll("details")) fold.open = true;
  });
})();
