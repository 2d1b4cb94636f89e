// Finds pages by what a person types. The entries come from a file beside this one, so that it
// works without a server: [address, title of the page, title of the part, other words, text].
"use strict";

const TITLE = 10, PART = 9, PAGE = 4, WORDS = 8, TEXT = 1.5, MOST = 25, SHORTEST_TYPO = 4;
const FOREIGN = 0.6, LONGEST_ENDING = 4, ENOUGH_PAIRS = 0.5, LONGEST_EXCERPT = 150;
// Words that say nothing of what is looked for, in all the languages of the site.
const UNIMPORTANT = new Set(`a an and at do does for how i in is it my of on the to what with
  das den der die ein eine einen ich ist man mein mit und wie
  como el en la las los mi que un una y
  comment de des du est et je le les ma mon une
  che come di gli il io lo mio per`.split(/\s+/));
const WORD = /[0-9a-z\u00df-\u024f]+|[\u3005\u3040-\u30ff\u3400-\u9fff]+/g;
const UNSPACED = /[\u3005\u3040-\u30ff\u3400-\u9fff]/;

function folded(text) {
  return text.normalize("NFKD").replace(/[\u0300-\u036f]/g, "").normalize("NFC").toLowerCase();
}

function wordsOf(text) {
  return folded(text).match(WORD) || [];
}

// Whether two words differ by one letter that is wrong, missing, too many, or two that changed place.
function isNear(typed, word) {
  if (Math.abs(typed.length - word.length) > 1) return false;
  let start = 0, end = 0;
  while (start < typed.length && typed[start] === word[start]) start++;
  while (end < Math.min(typed.length, word.length) - start
    && typed[typed.length - 1 - end] === word[word.length - 1 - end]) end++;
  const left = typed.slice(start, typed.length - end), right = word.slice(start, word.length - end);
  return left.length <= 1 && right.length <= 1
    || left.length === 2 && left[0] === right[1] && left[1] === right[0];
}

// How much of words that are written without spaces stands there: all of it, else pairs of letters.
function fitUnspaced(asked, plain) {
  if (plain.includes(asked)) return 1;
  let found = 0;
  for (let at = 0; at < asked.length - 1; at++) found += plain.includes(asked.slice(at, at + 2));
  const share = found / Math.max(1, asked.length - 1);
  return share >= ENOUGH_PAIRS ? 0.6 * share : 0;
}

function fit(asked, text, isForgiving) {
  if (UNSPACED.test(asked)) return fitUnspaced(asked, text.plain);
  let best = 0;
  for (const word of text.words) {
    if (word === asked) return 1;
    if (word.startsWith(asked)) best = Math.max(best, 0.7 * (0.5 + asked.length / word.length / 2));
    else if (word.length >= SHORTEST_TYPO && asked.length - word.length <= LONGEST_ENDING
      && asked.startsWith(word)) best = Math.max(best, 0.5);
    else if (isForgiving && asked.length >= SHORTEST_TYPO && isNear(asked, word)) {
      best = Math.max(best, 0.4);
    }
  }
  return best;
}

function prepared(entries) {
  return entries.map(([address, page, part, words, text]) => ({
    address, page, part, text,
    // the title of a page counts most where the page begins
    fields: [[page, part === page ? TITLE : PAGE], [part, PART], [words, WORDS], [text, TEXT]].map(([said, weight]) =>
      ({ weight, plain: folded(said), words: [...new Set(wordsOf(said))] })),
  }));
}

// The entries that have most of the words, the best first; those of the own folder count more.
function find(entries, typed, folder = "") {
  const said = wordsOf(typed);
  const meant = said.filter((word) => !UNIMPORTANT.has(word));
  const asked = meant.length ? meant : said;
  for (const isForgiving of [false, true]) {
    const hits = [];
    for (const entry of entries) {
      let score = 0, count = 0;
      for (const word of asked) {
        const best = Math.max(...entry.fields.map(
          (field) => field.weight * fit(word, field, isForgiving && field.weight > TEXT)));
        score += best;
        count += best > 0;
      }
      if (!entry.address.startsWith(folder)) score *= FOREIGN;
      if (count) hits.push({ entry, score, count });
    }
    const most = Math.max(0, ...hits.map((hit) => hit.count));
    const fewest = most - (asked.length > 2 && most > 1);
    for (const hit of hits) hit.score *= (hit.count / asked.length) ** 2;
    if (most === asked.length || isForgiving) {
      return hits.filter((hit) => hit.count >= fewest)
        .sort((a, b) => b.score - a.score).slice(0, MOST).map((hit) => hit.entry);
    }
  }
  return [];
}

// The words around the first place where something of what was typed stands.
function excerpt(entry, typed) {
  // letter by letter, so that places in both are the same
  const text = entry.text, plain = Array.from(text, (letter) => folded(letter)[0] || " ").join("");
  const places = wordsOf(typed).map((word) => plain.indexOf(word)).filter((at) => at >= 0);
  const start = places.length ? Math.max(0, Math.min(...places) - 40) : 0;
  const from = start ? text.indexOf(" ", start) + 1 : 0;
  if (text.length <= from + LONGEST_EXCERPT) return (from ? "… " : "") + text.slice(from);
  const shown = text.slice(from, from + LONGEST_EXCERPT).replace(/\s\S{0,20}$/, "");
  return `${from ? "… " : ""}${shown} …`;
}

function begin() {
  const form = document.querySelector(".search");
  const field = form.querySelector("input"), box = form.querySelector(".results");
  const told = form.querySelector("[role=status]");
  const { home, folder, english } = form.dataset;
  let entries = null;
  form.hidden = false;

  function show() {
    const typed = field.value.trim();
    box.hidden = !typed;
    box.replaceChildren();
    if (!typed || !entries) return;
    const hits = find(entries, typed, folder);
    told.textContent = hits.length ? `${hits.length} ${form.dataset.found}` : form.dataset.none;
    if (!hits.length) box.append(Object.assign(document.createElement("p"), {
      textContent: form.dataset.none }));
    const list = document.createElement("ol");
    for (const hit of hits) {
      const line = document.createElement("li"), link = document.createElement("a");
      link.href = home + hit.address;
      link.textContent = hit.part === hit.page ? hit.page : `${hit.page}: ${hit.part}`;
      link.addEventListener("click", () => { box.hidden = true; });
      if (!hit.address.startsWith(folder)) {
        line.lang = "en";
        link.append(Object.assign(document.createElement("span"), {
          className: "tongue", lang: document.documentElement.lang, textContent: ` (${english})` }));
      }
      line.append(link, Object.assign(document.createElement("p"), {
        textContent: excerpt(hit, typed) }));
      list.append(line);
    }
    box.append(list);
  }

  function load() {
    if (entries || form.dataset.asked) return;
    form.dataset.asked = "yes";
    const files = form.dataset.index.split(" ").map((file) => new Promise((loaded) => {
      const script = Object.assign(document.createElement("script"), { src: file });
      script.addEventListener("load", loaded);
      document.head.append(script);
    }));
    Promise.all(files).then(() => { entries = prepared(NEP_PAGES); show(); });
  }

  field.addEventListener("focus", load);
  field.addEventListener("input", () => { load(); show(); });
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    box.querySelector("a")?.click();
  });
  form.addEventListener("keydown", (event) => {
    const links = [field, ...box.querySelectorAll("a")], at = links.indexOf(document.activeElement);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && links[at + step]) { event.preventDefault(); links[at + step].focus(); }
    if (event.key === "Escape") { field.value = ""; show(); field.focus(); }
  });
  document.addEventListener("keydown", (event) => {
    const isTyping = /^(INPUT|TEXTAREA|SELECT)$/.test(document.activeElement.tagName);
    if (event.key === "/" && !isTyping) { event.preventDefault(); field.focus(); }
  });
}

if (typeof document !== "undefined") begin();
