"use strict";

// A table's head sorts its rows: numbers by value, what has none at the end, words by alphabet.
for (const table of document.querySelectorAll("table")) {
  const body = table.tBodies[0];
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    head.querySelector("button").addEventListener("click", () => {
      const descends = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", descends ? "descending" : "ascending");
      const sign = descends ? -1 : 1;
      const compare = (a, b) => {
        const [one, two] = [a, b].map((row) => row.cells[column]);
        if (!one.classList.contains("number")) {
          return sign * one.textContent.localeCompare(two.textContent, "en", { numeric: true });
        }
        const [x, y] = [one, two].map((cell) => cell.dataset.value);
        if (x === undefined || y === undefined) {
          return (x === undefined) - (y === undefined);
        }
        return sign * (x - y);
      };
      body.append(...[...body.rows].sort(compare));
    });
  });
}

// A slider moves the line between two pictures; its choices say which two.
for (const slider of document.querySelectorAll(".slider")) {
  const left = slider.querySelector(".left");
  const range = slider.querySelector("input");
  const pictures = slider.nextElementSibling.querySelectorAll("img");
  const move = () => {
    left.style.clipPath = `inset(0 ${100 - range.value}% 0 0)`;
  };
  range.addEventListener("input", move);
  for (const choice of slider.querySelectorAll("select")) {
    choice.addEventListener("change", () => {
      const image = slider.querySelector(`.${choice.dataset.side}`);
      image.src = pictures[choice.value].src;
      image.alt = pictures[choice.value].alt;
    });
  }
  move();
}
