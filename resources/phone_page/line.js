// The line to the computer: batches by WebSocket, by POST where that is refused, and again.

const BATCH_MS = 40;
const ALIVE_MS = 1000;          // an empty batch says that the page is still there
const SILENT_MS = 5000;         // the computer answers each second; then it is gone
const AGAIN_MS = [300, 700, 1500, 3000];
const MOST_WAITING = 600;       // samples; older ones are dropped
const MOST_SENT = 200;          // samples in one message
const MOST_BUFFERED = 32768;    // bytes that the phone may still have to send
const OPENING_MS = 6000;

const hex = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
const rounded = (value) => Math.round(value * 1e4) / 1e4;

export class Line {
  /** `told(state, rate_hz)`: "connecting", "followed", "busy", "lost" or "refused". */
  constructor(told, about) {
    this.told = told;
    this.about = about;         // gives {hand, device}
    this.id = hex(crypto.getRandomValues(new Uint8Array(8)));
    this.waiting = [];
    this.lost = 0;
    this.failures = 0;
    this.isPosting = false;     // by POST: iOS refuses WebSockets to a certificate of our own
    this.isBusy = false;
    this.isOver = false;        // the computer does not know this link
    this.heardAt = 0;
    this.sentAt = -ALIVE_MS;
    setInterval(() => this.flush(), BATCH_MS);
    this.open();
  }

  add(sample) {
    this.waiting.push(sample);
    if (this.waiting.length > MOST_WAITING) {
      this.lost += this.waiting.length - MOST_WAITING;
      this.waiting.splice(0, this.waiting.length - MOST_WAITING);
    }
    if (sample.t - this.waiting[0].t >= BATCH_MS / 1000) this.flush();
  }

  /** What was not sent yet is not sent any more. */
  drop() {
    this.waiting = [];
  }

  open() {
    if (this.isPosting) return;
    const socket = new WebSocket(`${location.origin.replace(/^http/, "ws")}${location.pathname}motion`);
    this.socket = socket;
    const timer = setTimeout(() => socket.close(), OPENING_MS);
    let wasOpen = false;
    socket.onopen = () => {
      clearTimeout(timer);
      wasOpen = true;
      this.failures = 0;
      this.heardAt = performance.now();
      this.sentAt = this.heardAt - ALIVE_MS; // so that it is heard of at once
      this.flush();
    };
    socket.onmessage = (message) => this.heard(message.data);
    socket.onclose = () => {
      clearTimeout(timer);
      if (this.socket !== socket) return;
      this.socket = null;
      this.findOut(wasOpen);
    };
  }

  /** Why it closed: the link may be of yesterday, the computer away, or only WebSockets refused. */
  async findOut(wasOpen) {
    try {
      const answer = await fetch("alive", { cache: "no-store" });
      if (answer.status === 403) return this.refuse();
      if (answer.ok && !wasOpen) {
        this.isPosting = true;
        this.heardAt = performance.now();
        return;
      }
    } catch { /* it is away */ }
    this.told("lost");
    const wait = AGAIN_MS[Math.min(this.failures++, AGAIN_MS.length - 1)];
    setTimeout(() => this.open(), wait);
  }

  refuse() {
    this.isOver = true;
    this.told("refused");
  }

  heard(text) {
    this.heardAt = performance.now();
    const { state, rate_hz } = JSON.parse(text);
    this.told(state, rate_hz);
  }

  flush() {
    const now = performance.now();
    if (this.isPosting) return this.post(now);
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    if (now - this.heardAt > SILENT_MS) return this.socket.close();
    if (this.socket.bufferedAmount > MOST_BUFFERED) return;
    const batch = this.batch(now);
    if (batch) this.socket.send(batch);
  }

  async post(now) {
    if (this.isBusy || this.isOver) return;
    const body = this.batch(now);
    if (!body) return;
    this.isBusy = true;
    try {
      const headers = { "Content-Type": "application/json" };
      const signal = AbortSignal.timeout?.(SILENT_MS);
      const answer = await fetch("batch", { method: "POST", body, headers, signal });
      if (answer.status === 403) return this.refuse();
      this.heard(await answer.text());
      this.failures = 0;
    } catch {
      this.told("lost");
      await new Promise((done) => setTimeout(done, AGAIN_MS[Math.min(this.failures++, 3)]));
    } finally {
      this.isBusy = false;
    }
  }

  /** The samples that wait, as text; null when there is nothing to say. */
  batch(now) {
    if (!this.waiting.length && now - this.sentAt < ALIVE_MS) return null;
    const samples = this.waiting.splice(0, MOST_SENT);
    const hasGyr = samples.length > 0 && samples.every((sample) => sample.gyr);
    const message = {
      ...this.about(),
      id: this.id,
      lost: this.lost,
      gravity: samples.every((sample) => sample.gravity),
      t: samples.map((sample) => rounded(sample.t)),
      acc: samples.map((sample) => sample.acc.map(rounded)),
      gyr: hasGyr ? samples.map((sample) => sample.gyr.map(rounded)) : null,
    };
    this.lost = 0;
    this.sentAt = now;
    return JSON.stringify(message);
  }
}
