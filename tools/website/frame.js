// What the frame does better with a script; all of it also goes without.
"use strict";

const shown = document.querySelector(".contents [aria-current]");
const contents = document.querySelector(".contents");
const languages = document.querySelector(".languages details");

// Long contents scroll by themselves: the page that is read is to be seen in them.
if (shown && getComputedStyle(contents).overflowY === "auto") {
  contents.scrollTop = shown.offsetTop - contents.offsetTop - contents.clientHeight / 2;
}

// A menu closes when one goes on elsewhere.
if (languages) {
  document.addEventListener("click", (event) => {
    if (!languages.contains(event.target)) languages.open = false;
  });
  languages.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !languages.open) return;
    languages.open = false;
    languages.querySelector("summary").focus();
  });
}
