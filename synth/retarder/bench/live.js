"use strict";
const SVG = "http://www.w3.org/2000/svg";
const ASK_EVERY_MS = 250;
const LEFT = 90, RIGHT = 880;
const where = JSON.parse(document.getElementById("data").textContent);
const byId = id => document.getElementById(id);

function shape(parent, tag, attributes, text) {
  const made = document.createElementNS(SVG, tag);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  parent.append(made);
}

/* A number between `low` and `high` as a place between `from` and `to`. */
const scale = (low, high, from, to) => value => from + (value - low) / (high - low) * (to - from);

function axis(svg, at, y, words) {
  shape(svg, "line", { x1: LEFT, x2: RIGHT, y1: y, y2: y, class: "axis" });
  shape(svg, "text", { x: LEFT - 8, y: y + 5, "text-anchor": "end" }, words ?? at);
}

/* Pieces of a line where it has values. */
function curve(svg, name, xs, ys) {
  const points = [];
  const end = () => { if (points.length > 1) shape(svg, "polyline", { class: name, points: points.join(" ") }); points.length = 0; };
  xs.forEach((x, i) => { if (ys[i] === null) end(); else points.push(`${x.toFixed(1)},${ys[i].toFixed(1)}`); });
  end();
}

function drawCut(svg, cut, trace) {
  svg.replaceChildren();
  if (!cut) return;
  const start = cut.nodes_m[0], x = scale(start, cut.exit_m, LEFT, RIGHT);
  const fastest = Math.ceil(Math.max(cut.target_m_s, ...trace.map(row => row[1])) + 0.5);
  const v = scale(0, fastest, 300, 20), highest = Math.max(100, ...trace.map(row => row[3]));
  const kpa = scale(0, highest, 400, 325);
  for (const [from, to] of cut.zones_m) shape(svg, "rect", { x: x(from), width: x(to) - x(from), y: 20, height: 280, class: "zone" });
  for (let each = 0; each <= fastest; each += 1) axis(svg, each, v(each), each === fastest ? `${each} m/s` : each);
  axis(svg, 0, kpa(0), "0 kPa");
  axis(svg, highest, kpa(highest), Math.round(highest));
  shape(svg, "text", { x: RIGHT, y: 418, "text-anchor": "end" }, `${cut.exit_m.toFixed(0)} m`);
  shape(svg, "line", { x1: LEFT, x2: RIGHT, y1: v(cut.target_m_s), y2: v(cut.target_m_s), class: "target" });
  const stage = trace.length ? trace[trace.length - 1][4] : 0;
  const shown = line => line.map(each => each === null || each > fastest || each < 0 ? null : v(each));
  curve(svg, "lower", cut.nodes_m.map(x), shown(cut.lower_m_s[stage]));
  curve(svg, "upper", cut.nodes_m.map(x), shown(cut.upper_m_s[stage]));
  for (const row of trace) if (row[2] !== null) shape(svg, "circle", { cx: x(row[0]), cy: v(row[2]), r: 2.5, class: "radar" });
  curve(svg, "true", trace.map(row => x(row[0])), trace.map(row => v(row[1])));
  curve(svg, "pressure", trace.map(row => x(row[0])), trace.map(row => kpa(row[3])));
}

function drawErrors(svg, errors) {
  svg.replaceChildren();
  const most = Math.max(0.1, ...errors.map(Math.abs)), y = scale(-most, most, 140, 20);
  const x = scale(0, Math.max(20, errors.length + 1), LEFT, RIGHT);
  for (const each of [-most, 0, most]) axis(svg, each, y(each), each.toFixed(2));
  errors.forEach((each, i) => shape(svg, "circle", { cx: x(i + 1), cy: y(each), r: 4, class: "dot" }));
}

function tile(figure, of) {
  const made = document.createElement("div"), strong = document.createElement("strong"), words = document.createElement("p");
  made.className = "tile";
  strong.textContent = figure;
  words.textContent = of;
  made.append(strong, words);
  return made;
}

function tell(now) {
  const speed = value => value === null ? "–" : `${value.toFixed(4)} m/s`;
  const cut = now.cut, last = now.trace[now.trace.length - 1], traffic = now.traffic;
  byId("state").textContent = cut
    ? `cut ${cut.count} of ${now.passes}: ${cut.label} to ${cut.target_m_s} m/s; ${traffic.connected} connected`
    : `no cut yet: waiting for a controller; ${traffic.connected} connected`;
  byId("tiles").replaceChildren(
    tile(last ? `stage ${last[4]}` : "–", last ? `in force at ${last[0].toFixed(1)} m` : "in force"),
    tile(speed(now.rms_m_s), `rms of the exit error of the cuts that left: ${now.ended}`),
    tile(speed(now.by_table_m_s), `the table on these cuts; it promises ${speed(now.promised_m_s)}`),
    tile(`${now.unanswered} of ${now.samples}`, "samples without an answer in time"),
    tile(`${traffic.refused}`, `of ${traffic.requests} requests refused; ${traffic.impossible} of a stage that is not there`));
  drawCut(byId("cut"), cut, now.trace);
  drawErrors(byId("errors"), now.errors_m_s);
}

async function ask() {
  try {
    tell(await (await fetch(where)).json());
    setTimeout(ask, ASK_EVERY_MS);
  } catch {
    byId("state").textContent = "the run is over, or the bench does not answer; its report is in the folder of the results";
    setTimeout(ask, 8 * ASK_EVERY_MS);
  }
}
ask();
