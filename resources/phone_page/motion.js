// Reads the phone's sensors: m/s² with gravity in Android's sign, rad/s, seconds.

const RAD = Math.PI / 180;
const EARTH = [7, 13];          // m/s²: how large the acceleration of a phone at rest may be
const FRESH_MS = 250;           // an orientation older than this says nothing of gravity
const VOTES = 15;

/** WebKit counts both accelerations towards the earth, all others away from it. */
function isWebKitOfApple() {
  return /iPhone|iPad|iPod/.test(navigator.userAgent)
    || (navigator.platform === "MacIntel" && navigator.maxTouchPoints > 1);
}

/** The sign that makes a phone that lies face up feel +9.81 along z, as Android says it. */
export class Sign {
  constructor() {
    this.value = isWebKitOfApple() ? -1 : 1;
    this.votes = 0;
    this.up = null;
  }

  /** The orientation has one meaning everywhere: it tells where up is in the phone's own axes. */
  turned(event) {
    if (event.beta === null || event.gamma === null) return;
    const beta = event.beta * RAD, gamma = event.gamma * RAD;
    this.up = [-Math.cos(beta) * Math.sin(gamma), Math.sin(beta), Math.cos(beta) * Math.cos(gamma)];
    this.upAt = performance.now();
  }

  /** A phone that hardly moves and knows where up is shows which sign its gravity has. */
  felt(acc) {
    if (!this.up || performance.now() - this.upAt > FRESH_MS) return;
    const size = Math.hypot(...acc);
    if (size < EARTH[0] || size > EARTH[1]) return;
    const along = acc.reduce((sum, part, axis) => sum + part * this.up[axis], 0) / size;
    if (Math.abs(along) < 0.9) return;
    const limited = this.votes + Math.sign(along);
    this.votes = Math.max(-VOTES, Math.min(VOTES, limited));
    if (Math.abs(this.votes) === VOTES) this.value = Math.sign(this.votes);
  }
}

/** One event as a sample; null where the device has no sensors behind it. */
export function sampleOf(event, sign) {
  const feels = whole(event.accelerationIncludingGravity, "x", "y", "z");
  const acc = feels ?? whole(event.acceleration, "x", "y", "z");
  if (!acc) return null;
  if (feels) sign.felt(feels);
  const turn = whole(event.rotationRate, "alpha", "beta", "gamma"); // around x, y and z
  return {
    t: (event.timeStamp > 0 ? event.timeStamp : performance.now()) / 1000,
    acc: acc.map((part) => part * sign.value),
    gyr: turn && turn.map((part) => part * RAD),
    gravity: Boolean(feels),
  };
}

function whole(parts, ...names) {
  if (!parts) return null;
  const values = names.map((name) => parts[name]);
  return values.every(Number.isFinite) ? values : null;
}

/** Asks for the sensors; must be called in a tap. Gives "granted" or "denied". */
export async function allowMotion() {
  const ask = (kind) => typeof kind?.requestPermission === "function"
    ? kind.requestPermission() : Promise.resolve("granted");
  try {
    const answer = ask(window.DeviceMotionEvent);
    ask(window.DeviceOrientationEvent).catch(() => {}); // only helps to find the sign
    return await answer;
  } catch {
    return "denied";
  }
}
