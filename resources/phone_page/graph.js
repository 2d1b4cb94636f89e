// Draws the acceleration of the last seconds: x solid, y dashed, z dotted.

const SECONDS = 4;
const AXES = [["--x", []], ["--y", [9, 5]], ["--z", [2, 5]]];
const FRAME_MS = 33;

export class Graph {
  constructor(canvas) {
    this.canvas = canvas;
    this.samples = [];
    this.range = 12;
    this.drawnAt = 0;
    this.isAsked = false;
  }

  add(sample) {
    this.samples.push(sample);
    while (this.samples[0].t < sample.t - SECONDS || this.samples[0].t > sample.t) this.samples.shift();
    if (!this.isAsked && performance.now() - this.drawnAt > FRAME_MS) {
      this.isAsked = true;
      requestAnimationFrame(() => this.draw());
    }
  }

  draw() {
    this.isAsked = false;
    this.drawnAt = performance.now();
    const box = this.canvas.getBoundingClientRect();
    if (!box.width || !this.samples.length) return;
    const scale = window.devicePixelRatio || 1;
    const [width, height] = [Math.round(box.width * scale), Math.round(box.height * scale)];
    if (this.canvas.width !== width || this.canvas.height !== height) {
      [this.canvas.width, this.canvas.height] = [width, height];
    }
    const pen = this.canvas.getContext("2d");
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, box.width, box.height);
    this.fit();
    const colours = getComputedStyle(document.documentElement);
    this.drawZero(pen, box, colours);
    for (const [axis, [colour, dash]] of AXES.entries()) this.drawAxis(pen, box, axis, colours.getPropertyValue(colour), dash);
  }

  /** The range grows at once and shrinks slowly, so that the eye can follow. */
  fit() {
    const largest = Math.max(...this.samples.map((sample) => Math.max(...sample.acc.map(Math.abs))));
    this.range = Math.max(12, largest * 1.05, this.range * 0.985);
  }

  drawZero(pen, box, colours) {
    pen.setLineDash([]);
    pen.strokeStyle = colours.getPropertyValue("--line");
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(0, box.height / 2);
    pen.lineTo(box.width, box.height / 2);
    pen.stroke();
  }

  drawAxis(pen, box, axis, colour, dash) {
    const last = this.samples[this.samples.length - 1].t;
    pen.setLineDash(dash);
    pen.lineCap = "round";
    pen.lineJoin = "round";
    pen.strokeStyle = colour;
    pen.lineWidth = 2.5;
    pen.beginPath();
    for (const sample of this.samples) {
      const x = box.width * (1 - (last - sample.t) / SECONDS);
      pen.lineTo(x, box.height / 2 * (1 - sample.acc[axis] / this.range));
    }
    pen.stroke();
  }
}
