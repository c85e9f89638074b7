"use strict";
// Plays one train of each run on one clock. All data are in the element "data"; nothing is loaded.
(() => {
  const { runs, trains } = JSON.parse(document.getElementById("data").textContent);
  const UNITS = { "m/s": 1, "km/h": 3.6, mph: 3600 / 1609.344 };
  const PASSES_TOLD = 10;
  const at = (id) => document.getElementById(id);
  const slider = at("slider");
  const asked = (key) => {
    const found = new RegExp(`[#&]${key}=(-?[0-9.]+)`).exec(location.hash);
    return found ? Number(found[1]) : null;
  };
  const chosen = Math.min(Math.trunc(Math.abs(asked("train") || 0)), trains.length - 1);

  // --- the unit of speeds; a browser may refuse a page from a disk to remember it
  const remembered = () => { try { return localStorage.getItem("unit"); } catch { return null; } };
  const remember = () => { try { localStorage.setItem("unit", unit); } catch { return; } };
  let unit = Object.hasOwn(UNITS, remembered() || "") ? remembered() : "m/s";
  const number = (m_s, digits = 2) => (m_s * UNITS[unit]).toFixed(digits);
  const withUnit = (m_s) => `${number(m_s)} ${unit}`;

  // --- the runs, one below the other
  const piece = (id, parent) => { parent.append(at(id).content.cloneNode(true)); return parent.lastElementChild; };
  const panels = runs.map((run) => {
    const part = piece("run", at("runs")), lists = piece("lists-of-run", at("lists"));
    part.querySelector(".name").textContent = run.name;
    for (const heading of lists.querySelectorAll("h2")) heading.prepend(run.name ? `${run.name}: ` : "");
    const ways = new TrainWays(run.trains[chosen]);
    return { run, ways, part, lists, plan: new PlanPanel(part.querySelector("svg"), run, ways, 1 / runs.length) };
  });

  // --- the clock
  const clock = {
    begin: Math.min(...panels.map(({ ways }) => ways.begin_s)),
    end: Math.max(...panels.map(({ ways }) => ways.end_s)),
    playing: false,
    before: null,
    start() {
      if (clock.now >= clock.end) clock.show(clock.begin);
      Object.assign(clock, { playing: true, before: null });
      at("play").textContent = "Pause";
      requestAnimationFrame(clock.tick);
    },
    stop() {
      clock.playing = false;
      at("play").textContent = "Play";
    },
    turn() { if (clock.playing) clock.stop(); else clock.start(); },
    tick(stamp) {
      if (!clock.playing) return;
      if (clock.before !== null) clock.show(clock.now + (stamp - clock.before) / 1000 * Number(at("rate").value));
      clock.before = stamp;
      if (clock.now >= clock.end) clock.stop(); else requestAnimationFrame(clock.tick);
    },
    slide(time) {
      clock.stop();
      alarms.jumped = null;
      clock.show(time);
    },
    show(time) {
      clock.now = Math.min(Math.max(time, clock.begin), clock.end);
      slider.value = clock.now;
      at("clock").value = `${clock.now.toFixed(1)} s`;
      for (const panel of panels) {
        const all = panel.plan.show(clock.now, at("colours").value, number);
        counters(panel);
        passes(panel);
        cuts(panel, all);
      }
      alarms.show(clock.now, at("alarm"));
    },
  };
  clock.now = asked("t") === null ? clock.begin : asked("t");
  const alarms = new Alarms(panels, at("marks"), clock, withUnit);

  // --- what is told of a run at an instant
  const many = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
  const counters = ({ ways, run, part }) => {
    const { cuts: over, cars, caught, overspeed } = ways.counts(clock.now), hump = ways.humpSpeed(clock.now);
    part.querySelector(".counted").textContent = [
      `${many(cars, "car")} humped`,
      `${many(caught, "cut")} caught up`,
      `${many(overspeed, "coupling")} above ${withUnit(run.coupling_limits_m_s[0])}`,
    ].join(" · ");
    const mean = ways.mean_hump_speed_m_s === null ? "" : `, mean of the train ${withUnit(ways.mean_hump_speed_m_s)}`;
    part.querySelector(".state").textContent =
      `${over} of ${ways.cuts.length} cuts let go; hump speed ${hump === null ? "–" : withUnit(hump)}${mean}`;
  };
  const passes = ({ run, ways, lists }) => {
    const begun = ways.passes.filter((pass) => pass.begin <= clock.now).slice(-PASSES_TOLD).reverse();
    fill(lists.querySelector(".passes"), begun.map((pass) => [
      run.plan.called[pass.number], pass.cut.place + 1, number(pass.entry), number(pass.command),
      clock.now < pass.end ? "…" : number(pass.exit),
    ]));
  };
  const cuts = ({ run, lists }, all) => fill(lists.querySelector(".cuts"), all.map(({ cut, head, speed, state }) => {
    const called = run.plan.tracks_called, waits = state === "waits";
    return [
      cut.place + 1, cut.cars, cut.mass_t.toFixed(0), run.categories[cut.category].name,
      cut.track === cut.wanted ? called[cut.track] : `${called[cut.wanted]}, went to ${called[cut.track]}`,
      waits ? "" : head.toFixed(0), waits ? "" : number(speed), stateOf(cut, state),
    ];
  }));
  const stateOf = (cut, state) => {
    if (state === "coupled") return `coupled at ${withUnit(cut.coupled_m_s)}`;
    return state === "stands" && cut.gap_m !== null ? `stands, gap ${cut.gap_m.toFixed(1)} m` : state;
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

  // --- words that change with the unit
  const key = (colour, text, kind = "") => {
    const entry = child(at("key"), "span");
    child(entry, "i", { className: kind }).style.background = colour;
    entry.append(text);
  };
  const words = () => {
    for (const each of document.querySelectorAll(".unit")) each.textContent = unit;
    alarms.words();
    at("key").replaceChildren();
    const { categories, coupling_limits_m_s: limits } = runs[0];
    const used = new Set(panels.flatMap(({ ways }) => ways.cuts.map(({ category }) => category)));
    for (const category of [...used].sort((one, other) => one - other)) {
      key(categories[category].colour, `category ${categories[category].name}`);
    }
    const above = limits.map((limit) => `above ${withUnit(limit)}`);
    const classes = [`coupled at up to ${withUnit(limits[0])}`, ...above];
    classes.forEach((text, place) => key(COUPLING_COLOURS[place], text, "dot"));
    const met = new Map(alarms.all.map(({ kind }) => [KINDS[kind].told, KINDS[kind].colour]));
    for (const [told, colour] of met) key(colour, `alarm: ${told}`, "tick");
    const textContent = `Beside a cut: its number and speed, ${unit}. At a retarder: the cut in it and ` +
      "its commanded exit speed, then the actual one. Orange sections are occupied; grey cars stood there before. " +
      "The key n goes on to the next alarm that is not pale, p back to the one before; space plays.";
    child(at("key"), "p", { textContent });
  };

  // --- what the user does
  const draw = () => {
    for (const { plan } of panels) plan.draw(at("view").value === "yard");
    clock.show(clock.now);
  };
  const on = (id, event, act) => at(id).addEventListener(event, act);
  on("slider", "input", () => clock.slide(Number(slider.value)));
  on("play", "click", clock.turn);
  on("next", "click", () => alarms.step(1));
  on("before", "click", () => alarms.step(-1));
  on("colours", "change", () => clock.show(clock.now));
  on("view", "change", draw);
  on("unit", "change", () => {
    unit = at("unit").value;
    remember();
    words();
    clock.show(clock.now);
  });
  on("train", "change", () => {
    location.hash = `train=${at("train").selectedIndex}`;
    location.reload();
  });
  window.addEventListener("resize", draw);
  document.addEventListener("keydown", (event) => {
    const { tagName } = event.target;
    if (tagName === "SELECT" || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "n") alarms.step(1);
    if (event.key === "p") alarms.step(-1);
    if (event.target === slider || tagName === "BUTTON") return;
    if (event.key === " ") { event.preventDefault(); clock.turn(); }
    if (event.key === "ArrowRight") clock.slide(clock.now + 1);
    if (event.key === "ArrowLeft") clock.slide(clock.now - 1);
  });
  slider.min = clock.begin;
  slider.max = clock.end;
  for (const title of trains) at("train").add(new Option(title));
  at("train").selectedIndex = chosen;
  for (const each of Object.keys(UNITS)) at("unit").add(new Option(each));
  at("unit").value = unit;
  at("next").disabled = at("before").disabled = alarms.severe.length === 0;
  words();
  draw();
})();
