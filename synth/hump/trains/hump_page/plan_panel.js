"use strict";
// The plan of one run with the cuts of its train. One text for a page of one run and of several.

const SVG = "http://www.w3.org/2000/svg";
const COUPLING_COLOURS = ["#009e73", "#f0c000", "#e8740c", "#b3001b"];
const ALARM = "#d55e00", QUIET = "#767676";
const BEHIND_CREST_M = 60, BEHIND_LAST_M = 90, TOLD_S = 6, COUPLER_M = 0.6;
const LEAST_ROW_PX = 9, MOST_ROW_PX = 60, PLAN_PX = 600, MARGIN_PX = 5;

const set = (node, attributes) => {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
};

const make = (kind, attributes, parent, text) => {
  const made = document.createElementNS(SVG, kind);
  set(made, attributes);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
  return made;
};

// Place on the plan of so many metres on a way.
const onWay = (way, m) => {
  if (m <= way[0][0]) return [way[0][1] + m - way[0][0], way[0][2]];
  let k = 1;
  while (k < way.length - 1 && way[k][0] < m) k += 1;
  const [m0, x0, y0] = way[k - 1], [m1, x1, y1] = way[k], share = (m - m0) / (m1 - m0);
  return [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
};

// Class of a coupling speed: 0 up to the first limit, then one more above each.
const couplingClass = (speed, limits) => limits.filter((limit) => speed > limit).length;

class PlanPanel {
  // svg: where it is drawn; share: of the height of a page that one run alone has.
  constructor(svg, run, ways, share) {
    Object.assign(this, { svg, plan: run.plan, limits: run.coupling_limits_m_s, categories: run.categories, ways, share });
    this.row = 0;
  }

  X(m) { return (m - this.from) / (this.to - this.from) * this.width; }
  Y(row) { return (row + 1.3) * this.row + MARGIN_PX; }
  get halfCut() { return Math.min(0.31 * this.row, 7); }

  line([x0, y0, x1, y1], kind) {
    return make("line", { x1: this.X(x0), y1: this.Y(y0), x2: this.X(x1), y2: this.Y(y1), class: kind }, this.svg);
  }

  // All that does not move, and the shapes of what does; wholeYard: the tracks to their ends.
  draw(wholeYard) {
    const { plan, svg } = this;
    this.from = -BEHIND_CREST_M;
    this.to = wholeYard ? plan.end_m * 1.02 : Math.min(plan.last_m + BEHIND_LAST_M, plan.end_m);
    svg.replaceChildren();
    this.width = svg.clientWidth || 1200;
    this.row = Math.min(Math.max(this.share * PLAN_PX / (plan.rows + 2), LEAST_ROW_PX), MOST_ROW_PX);
    this.height = Math.ceil((plan.rows + 1.6) * this.row + MARGIN_PX + 18);
    svg.setAttribute("height", this.height);
    svg.style.setProperty("--track", `${Math.min(10, 0.95 * this.row)}px`);
    this.axis();
    this.rails();
    const lined = (each, kind) => each.lines.map((ends) => this.line(ends, kind));
    this.sections = new Map(plan.sections.map((each) => [each.number, lined(each, `section ${each.kind}`)]));
    this.zones = new Map();
    for (const each of plan.zones) {
      this.zones.set(each.number, [...(this.zones.get(each.number) || []), this.line(each.line, "zone")]);
    }
    this.elements();
    this.shapes = this.ways.cuts.map((cut) => this.shape(cut));
    const dot = { r: Math.max(0.8 * this.halfCut, 3.5), class: "coupling" };
    this.couplings = this.ways.cuts.map(() => make("circle", dot, svg));
    this.told = new Map(plan.retarders.map(([number, x, y]) =>
      [number, make("text", { x: this.X(x), y: this.Y(y) + this.halfCut + 9, class: "told" }, svg)]));
  }

  axis() {
    const step = [20, 50, 100, 200].find((metres) => (this.to - this.from) / metres < this.width / 60) || 500;
    for (let m = Math.ceil(this.from / step) * step; m <= this.to; m += step) {
      make("line", { x1: this.X(m), x2: this.X(m), y1: 0, y2: this.height - 14, class: "axis" }, this.svg);
      make("text", { x: this.X(m), y: this.height - 3, "text-anchor": "middle", class: "number" }, this.svg, `${m} m`);
    }
  }

  rails() {
    const { plan, svg } = this;
    for (const rail of plan.rails) this.line(rail, "rail");
    for (const [, x, y] of plan.signals) this.line([x - 2000, y, x, y], "rail");
    const free = new Map();
    for (const cut of this.ways.cuts) if (!free.has(cut.track) && cut.free_m !== null) free.set(cut.track, cut.free_m);
    for (const [track, end, row] of plan.tracks) {
      const name = plan.tracks_called[track];
      if (free.has(track) && free.get(track) < end) this.line([free.get(track), row, end, row], "standing");
      const beyond = this.X(end) + 8 * name.length + 5 > this.width;
      const aside = beyond ? { x: this.width - 2, "text-anchor": "end" } : { x: this.X(end) + 3 };
      make("text", { ...aside, y: this.Y(row) + 3.5, class: "track" }, svg, name);
    }
  }

  // Names of switches, signals and retarders; each gives way to what moves.
  elements() {
    const { switches, signals, retarders, called } = this.plan;
    const all = [
      ...[...switches, ...signals].map((each) => [...each, -4, "end"]),
      ...retarders.map((each) => [...each, 0, "start"]),
    ].sort((one, other) => one[1] - other[1]);
    this.names = all.map(([number, x, y, aside, anchor]) => {
      const place = { x: this.X(x) + aside, y: this.Y(y) - 4, class: "number", "text-anchor": anchor };
      return { texts: [called[number], `${number}`], node: make("text", place, this.svg) };
    });
  }

  shape(cut) {
    const group = make("g", { class: "cut", "data-cut": cut.place + 1 }, this.svg);
    const track = this.plan.tracks_called[cut.wanted];
    make("title", {}, group, `cut ${cut.place + 1}: ${cut.cars} cars, ${cut.mass_t} t, to track ${track}`);
    const body = make("polyline", { "stroke-width": 2 * this.halfCut }, group);
    return { group, body, label: make("text", { "text-anchor": "middle" }, group) };
  }

  // One instant; speed(m_s): a speed in words. What every cut does.
  show(now, colours, speed) {
    this.svg.dataset.time = now.toFixed(2);
    const all = this.ways.places(now);
    this.labels = new Labels();
    // The last ones are nearest to the crest: where labels collide, theirs stay.
    for (const each of [...all].reverse()) this.moved(each, now, colours, speed);
    const held = this.ways.held(now);
    for (const [number, lines] of this.sections) {
      for (const each of lines) each.classList.toggle("occupied", held.has(number));
    }
    this.positions(now, speed);
    for (const { texts, node } of this.names) this.labels.put(node, texts);
    return all;
  }

  moved({ cut, head, speed: rolls, state }, now, colours, speed) {
    const { group, body, label } = this.shapes[cut.place], dot = this.couplings[cut.place];
    const way = this.plan.routes[cut.route], [x, y] = onWay(way, head), [X, Y] = [this.X(x), this.Y(y)];
    const seen = x >= this.from && x - cut.length_m <= this.to;
    Object.assign(group.dataset, { head: head.toFixed(2), speed: rolls.toFixed(2), state });
    group.style.display = seen ? "" : "none";
    dot.style.display = seen && state === "coupled" ? "" : "none";
    if (!seen) return;
    body.setAttribute("points", this.points(way, head - COUPLER_M, cut.length_m - 2 * COUPLER_M));
    const alarmed = this.ways.inAlarm(cut, now) ? ALARM : QUIET;
    body.setAttribute("stroke", colours === "category" ? this.categories[cut.category].colour : alarmed);
    const fill = COUPLING_COLOURS[couplingClass(cut.coupled_m_s, this.limits)];
    if (state === "coupled") set(dot, { cx: X, cy: Y, fill });
    const [middleX, middleY] = onWay(way, head - 0.5 * cut.length_m), number = `${cut.place + 1}`;
    set(label, { x: this.X(middleX), y: this.Y(middleY) - this.halfCut - 2 });
    this.labels.put(label, { rolls: [`${number}: ${speed(rolls, 1)}`, number], waits: [] }[state] || [number]);
  }

  // From head to tail of a cut on its way, bends between them too.
  points(way, head, length) {
    const bends = way.filter(([m]) => m > head - length && m < head).map(([, x, y]) => [x, y]);
    const all = [onWay(way, head - length), ...bends, onWay(way, head)];
    return all.map(([x, y]) => `${this.X(x).toFixed(1)},${this.Y(y).toFixed(1)}`).join(" ");
  }

  positions(now, speed) {
    const begun = this.ways.passes.filter((pass) => pass.begin <= now);
    const working = new Set(begun.filter((pass) => now < pass.end).map((pass) => pass.number));
    for (const [number, lines] of this.zones) {
      for (const each of lines) each.classList.toggle("works", working.has(number));
    }
    for (const [number, text] of this.told) {
      const last = begun.filter((pass) => pass.number === number && now < pass.end + TOLD_S).pop();
      this.labels.put(text, last ? toldOf(last, now, speed) : []);
    }
  }
}

// What a position was told, and when the cut has left it, what it did.
const toldOf = ({ cut, command, end, exit }, now, speed) => {
  const number = `${cut.place + 1}`, told = `${number}: set ${speed(command, 1)}`, left = `left ${speed(exit, 1)}`;
  return now < end ? [told] : [`${told}, ${left}`, `${number}: ${left}`];
};

// The labels of one instant. One that would lie on another that was put before is shortened, or left away.
const LETTER_PX = 5.9, LETTER_HEIGHT_PX = 9.5;

class Labels {
  constructor() { this.kept = []; }

  // texts: what node may say, the longest first.
  put(node, texts) {
    const fitting = texts.find((text) => this.hasRoom(boxOf(node, text)));
    if (fitting !== undefined) this.kept.push(boxOf(node, fitting));
    const told = fitting === undefined ? "" : fitting;
    if (node.textContent !== told) node.textContent = told;
  }

  hasRoom(box) {
    return !this.kept.some((other) =>
      box.left < other.right && other.left < box.right && Math.abs(box.y - other.y) < LETTER_HEIGHT_PX);
  }
}

const boxOf = (node, text) => {
  const [x, y] = ["x", "y"].map((key) => Number(node.getAttribute(key)));
  const width = LETTER_PX * text.length, anchor = node.getAttribute("text-anchor");
  const left = anchor === "middle" ? x - 0.5 * width : anchor === "end" ? x - width : x;
  return { left, right: left + width, y };
};
