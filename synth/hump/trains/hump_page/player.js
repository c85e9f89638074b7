"use strict";
// Plays a train on the plan. All data are in the element "data"; nothing is loaded.
(() => {
  const { plan, trains } = JSON.parse(document.getElementById("data").textContent);
  const wanted = /[#&]train=([0-9]+)/.exec(location.hash);
  const chosen = Math.min(wanted ? Number(wanted[1]) : 0, trains.length - 1);
  const train = trains[chosen];
  const SVG = "http://www.w3.org/2000/svg";
  const COLOURS = ["#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#222222", "#0072b2", "#f0e442"];
  const ALARM = "#d55e00", QUIET = "#767676";
  const BEHIND_CREST_M = 60, BEHIND_LAST_M = 90, TOLD_S = 6, COUPLER_M = 0.6, BEFORE_ALARM_S = 3;
  const at = (id) => document.getElementById(id);
  const svg = at("plan"), slider = at("slider");

  // --- where a cut is
  const sums = (steps) => { let sum = 0; return Float64Array.from(steps, (step) => (sum += step) / 100); };
  const cuts = train.cuts.map((cut, place) => ({ ...cut, place, t: sums(cut.t), s: sums(cut.s), v: sums(cut.v) }));
  const between = (x, xs, ys) => {
    const last = xs.length - 1;
    if (x <= xs[0]) return ys[0];
    if (x >= xs[last]) return ys[last];
    let low = 0, high = last;
    while (high - low > 1) { const middle = (low + high) >> 1; if (xs[middle] <= x) low = middle; else high = middle; }
    return ys[low] + (ys[high] - ys[low]) * (x - xs[low]) / (xs[high] - xs[low]);
  };
  // Head, speed and state of every cut at a time. Cuts that are not yet over the crest are pushed, one behind the other.
  const places = (time) => {
    let ahead = null;
    return cuts.map((cut) => {
      const last = cut.t.length - 1;
      let head, speed, state;
      if (time >= cut.t[0]) {
        head = between(time, cut.t, cut.s);
        const ends = time >= cut.t[last];
        speed = ends ? 0 : between(time, cut.t, cut.v);
        state = ends ? ended(cut) : time < cut.crest_s ? "pushed" : "rolls";
      } else {
        state = "waits";
        speed = 0;
        if (ahead === null) head = 0;
        else if (time <= ahead.cut.crest_s || cut.t[0] <= ahead.cut.crest_s) head = ahead.head - ahead.cut.length_m;
        else head = -0.5 * ahead.cut.length_m * (cut.t[0] - time) / (cut.t[0] - ahead.cut.crest_s);
        head = Math.min(head, 0);
      }
      ahead = { cut, head, speed, state };
      return ahead;
    });
  };
  const ended = (cut) => {
    if (cut.coupled_m_s !== null) return `coupled at ${cut.coupled_m_s.toFixed(2)} m/s`;
    return cut.gap_m !== null ? `stands, gap ${cut.gap_m.toFixed(1)} m` : "stands";
  };

  // --- from metres and rows to the screen
  const box = { width: 0, from: 0, to: 1, row: 18 };
  const X = (m) => (m - box.from) / (box.to - box.from) * box.width;
  const Y = (row) => (row + 1.3) * box.row;
  const onWay = (way, m) => {
    if (m <= way[0][0]) return [way[0][1] + m - way[0][0], way[0][2]];
    let k = 1;
    while (k < way.length - 1 && way[k][0] < m) k += 1;
    const [m0, x0, y0] = way[k - 1], [m1, x1, y1] = way[k], share = (m - m0) / (m1 - m0);
    return [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
  };
  const bodyPoints = (way, head, length) => {
    const inner = way.filter(([m]) => m > head - length && m < head).map(([, x, y]) => [x, y]);
    return [onWay(way, head - length), ...inner, onWay(way, head)].map(([x, y]) => `${X(x).toFixed(1)},${Y(y).toFixed(1)}`).join(" ");
  };
  const make = (kind, attributes, parent, text) => {
    const made = document.createElementNS(SVG, kind);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text !== undefined) made.textContent = text;
    parent.append(made);
    return made;
  };
  const line = ([x0, y0, x1, y1], kind, parent) =>
    make("line", { x1: X(x0), y1: Y(y0), x2: X(x1), y2: Y(y1), class: kind }, parent);

  // --- the plan, drawn anew for each view
  let sections = new Map(), zones = new Map(), told = new Map(), shapes = [];
  const draw = () => {
    svg.replaceChildren();
    box.width = svg.clientWidth || 1200;
    box.row = Math.min(Math.max(600 / (plan.rows + 2), 13), 60);
    const height = Math.ceil((plan.rows + 1.6) * box.row + 18);
    svg.setAttribute("height", height);
    const step = [20, 50, 100, 200].find((metres) => (box.to - box.from) / metres < 16) || 500;
    for (let m = Math.ceil(box.from / step) * step; m <= box.to; m += step) {
      make("line", { x1: X(m), x2: X(m), y1: 0, y2: height - 14, class: "axis" }, svg);
      make("text", { x: X(m), y: height - 3, "text-anchor": "middle", class: "number" }, svg, `${m} m`);
    }
    for (const rail of plan.rails) line(rail, "rail", svg);
    const lead = plan.signals[0];
    for (const [, x, y] of plan.signals) line([x - 2000, y, x, y], "rail", svg);
    const free = new Map();
    for (const cut of cuts) if (!free.has(cut.track) && cut.free_m !== null) free.set(cut.track, cut.free_m);
    for (const [track, end, row] of plan.tracks) {
      if (free.has(track) && free.get(track) < end) line([free.get(track), row, end, row], "standing", svg);
      const x = Math.min(X(end), box.width - 16);
      make("text", { x: x + 3, y: Y(row) + 3.5, class: "track" }, svg, track);
    }
    const lined = (each, kind) => each.lines.map((ends) => line(ends, kind, svg));
    sections = new Map(plan.sections.map((each) => [each.number, lined(each, `section ${each.kind}`)]));
    zones = new Map();
    for (const each of plan.zones) {
      zones.set(each.number, [...(zones.get(each.number) || []), line(each.line, "zone", svg)]);
    }
    for (const [number, x, y] of plan.switches) make("text", { x: X(x) - 4, y: Y(y) - 4, class: "number", "text-anchor": "end" }, svg, number);
    for (const [number, x, y] of plan.signals) make("text", { x: X(x) - 3, y: Y(y) - 6, class: "number", "text-anchor": "end" }, svg, number);
    for (const [number, x, y] of plan.retarders) make("text", { x: X(x), y: Y(y) - 5, class: "number" }, svg, number);
    shapes = cuts.map((cut) => {
      const group = make("g", { class: "cut", "data-cut": cut.place + 1 }, svg);
      make("title", {}, group, `cut ${cut.place + 1}: ${cut.cars} cars, ${cut.mass_t} t, to track ${cut.wanted}`);
      return { group, body: make("polyline", { "stroke-width": Math.min(0.62 * box.row, 14) }, group), label: make("text", { "text-anchor": "middle" }, group) };
    });
    told = new Map(plan.retarders.map(([number, x, y]) => [number, make("text", { x: X(x), y: Y(y) + Math.min(0.31 * box.row, 7) + 9, class: "told" }, svg)]));
  };

  // --- one instant
  const alarms = train.alarms.map((alarm) => ({ ...alarm, t: alarm.t === null ? train.end_s : alarm.t }));
  const passes = cuts.flatMap((cut) => cut.passes.map(([number, begin, end, entry, command, exit]) =>
    ({ cut, number, begin, end: end === null ? Infinity : end, entry, command, exit }))).sort((a, b) => a.begin - b.begin);
  const colourOf = (cut, time) => {
    if (at("colours").value === "category") return COLOURS[cut.category % COLOURS.length];
    return alarms.some((alarm) => alarm.severe && alarm.cut === cut.place && alarm.t <= time) ? ALARM : QUIET;
  };
  let now = train.begin_s;
  const show = (time) => {
    now = Math.min(Math.max(time, train.begin_s), train.end_s);
    slider.value = now;
    at("clock").value = `${now.toFixed(1)} s`;
    svg.dataset.time = now.toFixed(2);
    const all = places(now);
    all.forEach((each, place) => {
      const { group, body, label } = shapes[place], way = plan.routes[each.cut.route];
      group.dataset.head = each.head.toFixed(2);
      group.dataset.speed = each.speed.toFixed(2);
      group.dataset.state = each.state;
      const [x] = onWay(way, each.head);
      group.style.display = x < box.from || x - each.cut.length_m > box.to ? "none" : "";
      body.setAttribute("points", bodyPoints(way, each.head - COUPLER_M, each.cut.length_m - 2 * COUPLER_M));
      body.setAttribute("stroke", colourOf(each.cut, now));
      const [middleX, middleY] = onWay(way, each.head - 0.5 * each.cut.length_m);
      label.setAttribute("x", X(middleX));
      label.setAttribute("y", Y(middleY) - Math.min(0.31 * box.row, 7) - 2);
      label.textContent = each.state === "rolls" ? `${place + 1}: ${each.speed.toFixed(1)}` : each.state === "waits" ? "" : `${place + 1}`;
    });
    const held = new Set(train.occupied.filter(([, , from, to]) => from <= now && (to === null || now < to)).map(([number]) => number));
    for (const [number, lines] of sections) for (const each of lines) each.classList.toggle("occupied", held.has(number));
    const works = passes.filter((pass) => pass.begin <= now && now < pass.end);
    for (const [number, lines] of zones) for (const each of lines) each.classList.toggle("works", works.some((pass) => pass.number === number));
    for (const [number, text] of told) {
      const last = passes.filter((pass) => pass.number === number && pass.begin <= now && now < pass.end + TOLD_S).pop();
      text.textContent = !last ? "" :
        `${last.cut.place + 1}: set ${last.command.toFixed(1)}` +
        (now < last.end ? "" : `, left ${last.exit.toFixed(1)}`);
    }
    lists(all);
  };
  const lists = (all) => {
    const rows = passes.filter((pass) => pass.begin <= now).slice(-10).reverse();
    fill(at("passes"), rows.map((pass) => [pass.number, pass.cut.place + 1, pass.entry.toFixed(2), pass.command.toFixed(2),
      now < pass.end ? "…" : pass.exit.toFixed(2)]));
    fill(at("cuts"), all.map(({ cut, head, speed, state }) => [cut.place + 1, cut.cars, cut.mass_t.toFixed(0), train.categories[cut.category],
      cut.track === cut.wanted ? cut.track : `${cut.wanted}, went to ${cut.track}`, state === "waits" ? "" : head.toFixed(0),
      state === "waits" ? "" : speed.toFixed(2), state]));
    [...at("alarms").children].forEach((item, place) => item.classList.toggle("past", alarms[place] !== undefined && alarms[place].t <= now));
    const over = cuts.filter((cut) => cut.crest_s <= now).length;
    const hump = over === 0 || over === cuts.length ? null
      : between(now, [cuts[over - 1].crest_s, cuts[over].crest_s], [cuts[over - 1].hump_speed_m_s, cuts[over].hump_speed_m_s]);
    at("state").textContent = `${over} of ${cuts.length} cuts let go; hump speed ${hump === null ? "–" : hump.toFixed(2) + " m/s"}` +
      (train.mean_hump_speed_m_s === null ? "" : `, mean of the train ${train.mean_hump_speed_m_s.toFixed(2)} m/s`) +
      `; severe alarms so far: ${alarms.filter((alarm) => alarm.severe && alarm.t <= now).length}`;
  };
  const fill = (body, rows) => {
    while (body.rows.length > rows.length) body.deleteRow(-1);
    rows.forEach((cells, place) => {
      const row = body.rows[place] || body.insertRow();
      cells.forEach((text, column) => {
        const cell = row.cells[column] || row.insertCell();
        if (cell.textContent !== String(text)) cell.textContent = text;
      });
    });
  };

  // --- what the user does
  let playing = false, before = null;
  const play = (on) => {
    playing = on;
    before = null;
    at("play").textContent = on ? "Pause" : "Play";
    if (on) requestAnimationFrame(tick);
  };
  const tick = (stamp) => {
    if (!playing) return;
    if (before !== null) show(now + (stamp - before) / 1000 * Number(at("rate").value));
    before = stamp;
    if (now >= train.end_s) play(false); else requestAnimationFrame(tick);
  };
  const view = () => {
    box.from = -BEHIND_CREST_M;
    box.to = at("view").value === "hump" ? Math.min(plan.last_m + BEHIND_LAST_M, plan.end_m) : plan.end_m * 1.02;
    draw();
    show(now);
  };
  for (const alarm of alarms) {
    const item = document.createElement("li"), button = document.createElement("button");
    button.type = "button";
    button.textContent = `${alarm.t.toFixed(1)} s: ${alarm.words}`;
    button.addEventListener("click", () => { play(false); show(alarm.t - BEFORE_ALARM_S); });
    item.classList.toggle("pale", !alarm.severe);
    item.append(button);
    at("alarms").append(item);
  }
  if (alarms.length === 0) at("alarms").append(Object.assign(document.createElement("li"), { textContent: "none" }));
  for (const category of new Set(cuts.map((cut) => cut.category).sort((a, b) => a - b))) {
    const entry = document.createElement("span"), patch = document.createElement("i");
    patch.style.background = COLOURS[category % COLOURS.length];
    entry.append(patch, `category ${train.categories[category]}`);
    at("key").append(entry);
  }
  at("key").append("Beside a cut: its number and speed, m/s. At a retarder: the cut in it and its commanded exit speed, then the actual one. Orange sections are occupied.");
  slider.min = train.begin_s;
  slider.max = train.end_s;
  slider.addEventListener("input", () => { play(false); show(Number(slider.value)); });
  at("play").addEventListener("click", () => { if (!playing && now >= train.end_s) show(train.begin_s); play(!playing); });
  at("colours").addEventListener("change", () => show(now));
  at("view").addEventListener("change", view);
  window.addEventListener("resize", view);
  document.addEventListener("keydown", (event) => {
    if (event.target.tagName === "SELECT" || event.target === slider || event.target.tagName === "BUTTON") return;
    if (event.key === " ") { event.preventDefault(); play(!playing); }
    if (event.key === "ArrowRight") show(now + 1);
    if (event.key === "ArrowLeft") show(now - 1);
  });
  const menu = at("train");
  for (const each of trains) menu.add(new Option(each.title));
  menu.selectedIndex = chosen;
  menu.addEventListener("change", () => { location.hash = `train=${menu.selectedIndex}`; location.reload(); });
  const asked = /[#&]t=(-?[0-9.]+)/.exec(location.hash);
  if (asked) now = Number(asked[1]);
  view();
})();
