"use strict";
// A chart on a canvas: axes with units, lines, dots and bands. Colours are those of the style sheet, dark or light.
class Chart {
  constructor(canvas) {
    Object.assign(this, { canvas, pen: canvas.getContext("2d") });
  }

  // A colour of the style sheet, asked for once a drawing: it differs by day and night.
  colour(name) {
    const styles = getComputedStyle(document.documentElement);
    return (this.colours[name] ??= styles.getPropertyValue(`--${name}`).trim());
  }

  // Clears the canvas and draws the axes; `x`, `y`: [least, greatest], `titles` of both; `room` behind them, pixels.
  begin({ x, y, titles, room = 10 }) {
    const { canvas, pen } = this, scale = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = Math.round(width * scale);
    canvas.height = Math.round(height * scale);
    pen.setTransform(scale, 0, 0, scale, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "12px system-ui, sans-serif";
    Object.assign(this, { x, y, colours: {}, left: 46, right: width - room, top: 18, bottom: height - 34 });
    this.axes(titles);
  }

  // Where a number is.
  atX(value) { return this.left + (value - this.x[0]) / (this.x[1] - this.x[0]) * (this.right - this.left); }
  atY(value) { return this.bottom - (value - this.y[0]) / (this.y[1] - this.y[0]) * (this.bottom - this.top); }

  // The number at a place of the pointer.
  xAt(pixels) { return this.x[0] + (pixels - this.left) / (this.right - this.left) * (this.x[1] - this.x[0]); }

  static ticks([low, high], most) {
    const least = (high - low) / most, power = 10 ** Math.floor(Math.log10(least));
    const step = [1, 2, 5, 10].map((times) => times * power).find((each) => each >= least);
    const found = [], digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let tick = Math.ceil(low / step - 1e-9); tick * step <= high + 1e-9 * step; tick++) {
      found.push([tick * step, (tick * step).toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1").replace("-", "−")]);
    }
    return found;
  }

  axes([xTitle, yTitle]) {
    const { pen } = this;
    pen.lineWidth = 1;
    pen.strokeStyle = this.colour("line");
    pen.fillStyle = this.colour("soft");
    pen.textAlign = "center";
    for (const [value, text] of Chart.ticks(this.x, Math.max(3, (this.right - this.left) / 70))) {
      this.stroke([[this.atX(value), this.bottom], [this.atX(value), this.bottom + 4]]);
      pen.fillText(text, this.atX(value), this.bottom + 16);
    }
    pen.textAlign = "right";
    for (const [value, text] of Chart.ticks(this.y, 6)) {
      this.stroke([[this.left, this.atY(value)], [this.right, this.atY(value)]]);
      pen.fillText(text, this.left - 5, this.atY(value) + 4);
    }
    pen.fillText(xTitle, this.right, this.bottom + 30);
    pen.textAlign = "left";
    pen.fillText(yTitle, 4, 12);
  }

  stroke(pixels) {
    const { pen } = this;
    pen.beginPath();
    pixels.forEach(([x, y], place) => { if (place === 0) pen.moveTo(x, y); else pen.lineTo(x, y); });
    pen.stroke();
  }

  // Runs `draw` with everything outside the axes cut off.
  inside(draw) {
    const { pen } = this;
    pen.save();
    pen.beginPath();
    pen.rect(this.left, this.top, this.right - this.left, this.bottom - this.top);
    pen.clip();
    draw();
    pen.restore();
  }

  line(points, colour, { width = 2, dash = [], alpha = 1 } = {}) {
    const { pen } = this;
    this.inside(() => {
      Object.assign(pen, { strokeStyle: this.colour(colour), lineWidth: width, globalAlpha: alpha, lineJoin: "round" });
      pen.setLineDash(dash);
      this.stroke(points.map(([x, y]) => [this.atX(x), this.atY(y)]));
    });
  }

  // Many lines of one kind, drawn at once.
  lines(all, colour, { width = 1, alpha = 1 } = {}) {
    const { pen } = this;
    this.inside(() => {
      Object.assign(pen, { strokeStyle: this.colour(colour), lineWidth: width, globalAlpha: alpha });
      for (const points of all) this.stroke(points.map(([x, y]) => [this.atX(x), this.atY(y)]));
    });
  }

  dots(points, colour, { radius = 2.5, hollow = false } = {}) {
    const { pen } = this;
    this.inside(() => {
      Object.assign(pen, { strokeStyle: this.colour(colour), fillStyle: this.colour(colour), lineWidth: 1.2 });
      for (const [x, y] of points) {
        pen.beginPath();
        pen.arc(this.atX(x), this.atY(y), radius, 0, 2 * Math.PI);
        if (hollow) pen.stroke(); else pen.fill();
      }
    });
  }

  // A short level bar, `isOpen` a dashed one.
  bar(x, y, colour, isOpen) {
    const { pen } = this, at = [this.atX(x), this.atY(y)];
    this.inside(() => {
      Object.assign(pen, { strokeStyle: this.colour(colour), lineWidth: 3 });
      pen.setLineDash(isOpen ? [4, 2] : []);
      this.stroke([[at[0] - 8, at[1]], [at[0] + 8, at[1]]]);
    });
  }

  // A triangle on the axis of x.
  foot(x, colour) {
    const { pen, bottom } = this, at = this.atX(x);
    this.inside(() => {
      pen.fillStyle = this.colour(colour);
      pen.beginPath();
      for (const [dx, dy] of [[-5, 0], [5, 0], [0, -9]]) pen.lineTo(at + dx, bottom + dy);
      pen.fill();
    });
  }

  // A filled rectangle; null where it reaches the edge of the chart.
  band([x0, x1], [y0, y1], colour, alpha = 1) {
    const { pen } = this;
    this.inside(() => {
      Object.assign(pen, { fillStyle: this.colour(colour), globalAlpha: alpha });
      const [left, right] = [x0 === null ? this.left : this.atX(x0), x1 === null ? this.right : this.atX(x1)];
      const [low, high] = [y0 === null ? this.bottom : this.atY(y0), y1 === null ? this.top : this.atY(y1)];
      pen.fillRect(left, high, right - left, low - high);
    });
  }

  upright(x, colour, dash = []) { this.line([[x, this.y[0]], [x, this.y[1]]], colour, { width: 1.5, dash }); }

  // A word behind the axes, in the `room`.
  wordBehind(text, y, colour) {
    Object.assign(this.pen, { fillStyle: this.colour(colour), textAlign: "left" });
    this.pen.fillText(text, this.right + 5, this.atY(y) + 4);
  }
}
