"use strict";
// Marks in figures say their numbers: at the pointer, and beside the mark for the keyboard.
(() => {
  const tip = document.getElementById("tip");
  const place = (x, y) => {
    const box = tip.getBoundingClientRect();
    tip.style.left = Math.max(4, Math.min(x + 14, innerWidth - box.width - 4)) + "px";
    tip.style.top = Math.max(4, y + 18 + box.height > innerHeight ? y - box.height - 10 : y + 18) + "px";
  };
  const say = (mark, x, y) => { tip.textContent = mark.dataset.tip; tip.hidden = false; place(x, y); };
  const hush = () => { tip.hidden = true; };
  for (const mark of document.querySelectorAll(".mark")) {
    const title = mark.querySelector("title");
    if (title) title.remove();
    mark.setAttribute("tabindex", "0");
    mark.setAttribute("role", "img");
    mark.setAttribute("aria-label", mark.dataset.tip);
    mark.addEventListener("pointermove", (e) => say(mark, e.clientX, e.clientY));
    mark.addEventListener("pointerleave", hush);
    mark.addEventListener("focus", () => {
      const box = mark.getBoundingClientRect();
      say(mark, box.right, box.top);
    });
    mark.addEventListener("blur", hush);
  }
  document.addEventListener("keydown", (e) => { if (e.key === "Escape") hush(); });
  addEventListener("beforeprint", () => {
    for (const fold of document.querySelectorAll("details")) fold.open = true;
  });
})();
