// The page itself: what is shown when, in the phone's language.

import { Graph } from "./graph.js";
import { Line } from "./line.js";
import { Sign, allowMotion, sampleOf } from "./motion.js";

const NO_SENSORS_MS = 2500;
const EMPTY_MS = 400;           // after an event without values, which says that there are no sensors
const RATE_OVER = 60;           // samples
const HAND = "nep-studio-hand";
const element = (id) => document.getElementById(id);

let words = {};
let line = null;
let lineState = "connecting";   // connecting, followed, busy, lost, refused
let motion = "asleep";          // asleep, asking, on, none, denied
let wakeLock = null;
let noSensors = 0;
const sign = new Sign();
const times = [];
const graph = new Graph(element("graph"));

/** What the page shows: what stops everything first, then what the person can do. */
function shown() {
  if (!window.isSecureContext) return "insecure";
  if (lineState === "refused") return "refused";
  if (motion === "denied" || motion === "none") return motion;
  if (lineState === "lost") return "lost";
  if (motion === "asleep") return lineState === "connecting" ? "connecting" : "ready";
  if (motion === "asking") return "asking";
  if (lineState === "busy") return "busy";
  return lineState === "followed" && times.length > 1 ? "live" : "connecting";
}

function show() {
  const state = shown();
  const isOn = motion === "on";
  if (document.body.dataset.state !== state || element("state").textContent !== words[state]) {
    document.body.dataset.state = state;
    element("state").textContent = words[state];
    element("hint").textContent = words[hintOf(state)] ?? "";
  }
  element("allow").hidden = ["insecure", "refused", "none", "asking"].includes(state)
    || (state === "connecting" && !isOn);
  element("allow").textContent = isOn ? words.stop : motion === "denied" ? words.again : words.allow;
  element("live").hidden = !isOn;
  element("where").hidden = ["insecure", "refused", "none", "denied"].includes(state);
  const isLive = state === "live";
  element("rate").textContent = isLive ? words.rate.replace("{hz}", Math.round(rateHz())) : "";
}

function hintOf(state) {
  const isApple = /iPhone|iPad|iPod/.test(navigator.userAgent);
  return state === "denied" && isApple ? "denied_hint_ios" : `${state}_hint`;
}

function rateHz() {
  return times.length < 2 ? 0 : (times.length - 1) / (times[times.length - 1] - times[0]);
}

function onMotion(event) {
  if (motion !== "on") return;
  const sample = sampleOf(event, sign);
  if (!sample) {
    if (!times.length) expectSensors(EMPTY_MS);
    return;
  }
  clearTimeout(noSensors);
  if (times.length && sample.t <= times[times.length - 1]) return; // one event, told twice
  times.push(sample.t);
  if (times.length > RATE_OVER) times.shift();
  graph.add(sample);
  line.add(sample);
}

async function start() {
  motion = "asking";
  show();
  if (!window.DeviceMotionEvent) {
    motion = "none";
  } else if (await allowMotion() === "granted") {
    motion = "on";
    times.length = 0;
    window.addEventListener("devicemotion", onMotion);
    window.addEventListener("deviceorientation", onTurn);
    expectSensors(NO_SENSORS_MS);
    keepAwake();
  } else {
    motion = "denied";
  }
  show();
}

function expectSensors(within) {
  clearTimeout(noSensors);
  noSensors = setTimeout(() => stop("none"), within);
}

function stop(next) {
  motion = next;
  line.drop();
  clearTimeout(noSensors);
  window.removeEventListener("devicemotion", onMotion);
  window.removeEventListener("deviceorientation", onTurn);
  wakeLock?.release().catch(() => {});
  wakeLock = null;
  show();
}

const onTurn = (event) => sign.turned(event);

/** The screen stays on where the browser can do that: a phone that sleeps sends nothing. */
async function keepAwake() {
  try {
    wakeLock = await navigator.wakeLock?.request("screen");
  } catch {
    wakeLock = null;
  }
}

function device() {
  const found = /iPhone|iPad|iPod|Android/.exec(navigator.userAgent);
  return found ? found[0] : "";
}

function translate() {
  document.querySelectorAll("[data-word]").forEach((each) => {
    each.textContent = words[each.dataset.word];
  });
  element("graph").setAttribute("aria-label", words.graph);
}

async function loadWords() {
  const all = await (await fetch("words.json")).json();
  const wanted = navigator.languages.map((name) => name.slice(0, 2).toLowerCase());
  const language = wanted.find((name) => name in all) ?? "en";
  words = { ...all.en, ...all[language] };
  document.documentElement.lang = language;
}

function chosenHand() {
  return document.querySelector("input[name=hand]:checked").value;
}

function rememberHand() {
  const kept = sessionStorage.getItem(HAND);
  const input = kept && document.querySelector(`input[name=hand][value="${CSS.escape(kept)}"]`);
  if (input) input.checked = true;
  element("where").addEventListener("change", () => sessionStorage.setItem(HAND, chosenHand()));
}

async function main() {
  await loadWords();
  translate();
  rememberHand();
  element("allow").addEventListener("click", () => (motion === "on" ? stop("asleep") : start()));
  document.addEventListener("visibilitychange", () => {
    if (document.visibilityState === "visible" && motion === "on") keepAwake();
  });
  line = new Line((state) => { lineState = state; show(); },
    () => ({ hand: chosenHand(), device: device() }));
  setInterval(show, 500);
  show();
}

main().catch(() => { // the texts themselves did not come
  document.body.dataset.state = "lost";
  element("state").textContent = "The page did not load completely";
  element("hint").textContent = "Open the link again.";
});
