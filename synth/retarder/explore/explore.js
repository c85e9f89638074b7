"use strict";
// The page: what is set, one pass of it at once, then many. All data are in the element "data"; nothing is loaded.
(() => {
  const { classes, overspeed_m_s: overspeedMS, alarms } = JSON.parse(document.getElementById("data").textContent);
  const LINK_AFTER_MS = 250, MANY_AFTER_MS = 200, FEW_PASSES = 100, ONE_PASS = 0;
  const at = (id) => document.getElementById(id);
  const on = (id, event, act) => at(id).addEventListener(event, act);
  const choices = classes.flatMap((of) => of.tables.map((told) => ({ of, told })));
  const charts = Object.fromEntries(["speed", "pressure", "cloud", "histogram"].map((id) => [id, new Chart(at(id))]));
  const set = { choice: 0, values: null, cursor: null, unit: "m/s" };
  let shown = null, waitsForCloud = 0, waitsForLink = 0;

  const plantOf = () => choices[set.choice].of.plant;
  const number = (m_s, digits = 2) => (m_s * SpeedUnits.FACTORS[set.unit]).toFixed(digits);
  const withUnit = (m_s, digits = 2) => `${number(m_s, digits)} ${set.unit}`;
  const signed = (m_s, digits) => `${m_s < 0 ? "−" : "+"}${number(Math.abs(m_s), digits)}`;

  // --- passes
  function settingOf(plant, table) {
    const { mass: massT, noise: noiseMS, delay } = set.values;
    return { massT, noiseMS, drive: Drive.drive(plant, table.at_any_time === 1, delay) };
  }

  function passOf(plant, table, setting, cut) {
    const questions = [], points = [];
    const exit = Passes.run(plant, table, setting, cut, (time, s, v, _kpa, _stage, question) => {
      points.push([s, v]);
      if (question) questions.push({ time, v, question });
    });
    points.push([exit.s, exit.stalled ? 0 : exit.exitMS]);
    return { exit, questions, points };
  }

  // The one pass of the sliders, and everything that is drawn of it.
  function update() {
    const { of, told } = choices[set.choice], { plant } = of, { values } = set, table = of.made(told);
    const cut = { ...Draws.cut(plant, values.seed, ONE_PASS), entryMS: values.entry, factor: values.factor,
      resistance: values.resistance };
    const pass = passOf(plant, table, settingOf(plant, table), cut);
    shown = { plant, table, told, pass, targetMS: told.target_m_s };
    const first = pass.questions.findIndex(({ question }) => question.wanted !== question.before);
    if (set.cursor === null) set.cursor = Math.max(0, first);
    set.cursor = Math.min(set.cursor, pass.questions.length - 1);
    tellExit();
    drawPass();
    clearTimeout(waitsForCloud);
    waitsForCloud = setTimeout(manyPasses, Number(at("passes").value) > FEW_PASSES ? MANY_AFTER_MS : 0);
    clearTimeout(waitsForLink);
    waitsForLink = setTimeout(writeLink, LINK_AFTER_MS);
  }

  function tellExit() {
    const { exit } = shown.pass, error = exit.exitMS - shown.targetMS, panel = at("exit");
    panel.className = !exit.stalled && error > overspeedMS ? "fast" : "";
    const commands = `${exit.commands} command${exit.commands === 1 ? "" : "s"}`;
    panel.textContent = exit.stalled
      ? `The cut stands at ${exit.s.toFixed(1)} m after ${exit.time.toFixed(1)} s; ${commands}.`
      : `Exit ${withUnit(exit.exitMS)}, target ${withUnit(shown.targetMS)}: error ${signed(error)} ${set.unit}; ` +
        `${commands}, ${exit.time.toFixed(1)} s.`;
  }

  function drawPass() {
    Object.assign(shown, { cursor: set.cursor, factor: SpeedUnits.FACTORS[set.unit], unit: set.unit });
    Pictures.speedOverPath(charts.speed, shown);
    Pictures.pressureOverTime(charts.pressure, shown);
    const moment = shown.pass.questions[set.cursor], slider = at("moment");
    slider.max = shown.pass.questions.length - 1;
    slider.value = set.cursor;
    const sentences = moment ? Words.why(shown.plant, shown.table, moment, withUnit, alarms)
      : ["The pass ended before the first sample."];
    at("why").replaceChildren(...sentences.map((textContent) => Object.assign(document.createElement("li"), { textContent })));
  }

  function manyPasses() {
    const { plant, table, told } = shown, count = Number(at("passes").value), setting = settingOf(plant, table);
    const passes = Array.from({ length: count }, (_, place) =>
      passOf(plant, table, setting, Draws.cut(plant, set.values.seed, ONE_PASS + 1 + place)));
    shown.many = passes;
    const exits = passes.map(({ exit }) => exit);
    at("count").textContent = count;
    Pictures.cloud(charts.cloud, shown, passes);
    Pictures.histogram(charts.histogram, shown, exits, told.predicted, overspeedMS);
    compare(Figures.of(exits, shown.targetMS, overspeedMS), told);
    at("differs").textContent = Controls.isConfigured(plant, set.values) ? ""
      : "Mass, noise or delays are not those of the configuration: the figures of the table are not for this plant.";
  }

  function compare(found, { predicted, validated }) {
    const speed = (value) => number(value, 4), percent = (value) => `${(100 * value).toFixed(2)} %`;
    const plain = (value) => value.toFixed(1);
    const row = (name, form, key, own) => [name, `${form(found[key][0])} [${form(found[key][1])}, ${form(found[key][2])}]`, own];
    const checked = validated ? `; validated ${speed(validated.rms_m_s)} ` +
      `[${validated.rms_ci95_m_s.map(speed).join(", ")}] in ${validated.passes} passes` : "";
    const rows = [
      [`rms of the exit error, ${set.unit}`, `${speed(found.rms)} of these cuts`, speed(predicted.rms_m_s) + checked],
      row(`95 of 100 cuts leave within ±, ${set.unit}`, speed, "within", "not told"),
      row(`mean exit error, ${set.unit}`, speed, "bias", speed(predicted.bias_m_s)),
      row(`more than ${withUnit(overspeedMS, 1)} too fast`, percent, "overspeed", percent(predicted.p_overspeed)),
      row("stands in the position", percent, "stalled",
        predicted.p_stall === null ? "not told" : percent(predicted.p_stall)),
      row("commands of a cut", plain, "commands", plain(predicted.switchings)),
      row("time from where the regulator acts, s", plain, "time", "not told"),
    ];
    at("here").textContent = `here, ${found.n} cuts`;
    at("told").textContent = `as the table tells: ${predicted.passes === null ? "exact by the model"
      : `from ${predicted.passes} simulated passes`}`;
    at("figures").replaceChildren(...rows.map(([name, ...cells]) => {
      const made = document.createElement("tr");
      for (const [tag, textContent] of [["th", name], ...cells.map((cell) => ["td", cell])]) {
        made.append(Object.assign(document.createElement(tag), { textContent }));
      }
      return made;
    }));
  }

  // --- the state and its link
  function writeLink() {
    const others = { unit: set.unit, at: set.cursor };
    const link = Controls.link(plantOf(), choices[set.choice].told.id, set.values, others);
    try { history.replaceState(null, "", link); } catch { return; }  // a browser may refuse it for a file
  }

  function readLink() {
    const words = Controls.asked(), found = choices.findIndex(({ told }) => told.id === words.get("table"));
    set.choice = Math.max(0, found);
    set.values = Controls.valuesAsked(plantOf(), words);
    set.unit = SpeedUnits.known(words.get("unit")) ? words.get("unit") : SpeedUnits.remembered();
    const moment = Number(words.get("at") ?? NaN);
    set.cursor = Number.isInteger(moment) && moment >= 0 && words.has("at") ? moment : null;
  }

  // --- sliders
  const sliders = new Map();
  function showSliders() {
    const plant = plantOf();
    for (const [{ key, label, isSpeed, range, step, digits }, { name, input, output }] of sliders) {
      const [low, high] = range(plant);
      Object.assign(input, { min: low, max: high, step: low === high ? "any" : step, disabled: low === high });
      input.value = set.values[key];
      name.textContent = isSpeed ? `${label}, ${set.unit}` : label;
      output.value = isSpeed ? number(set.values[key], digits) : set.values[key].toFixed(digits);
    }
  }

  function makeSliders() {
    for (const slider of Controls.SLIDERS) {
      const row = Object.assign(document.createElement("div"), { className: "slider" });
      const name = Object.assign(document.createElement("label"), { htmlFor: slider.key });
      const input = Object.assign(document.createElement("input"), { type: "range", id: slider.key });
      const output = Object.assign(document.createElement("output"), { htmlFor: slider.key });
      input.addEventListener("input", () => change({ [slider.key]: Number(input.value) }));
      row.append(name, input, output);
      at(slider.of).append(row);
      sliders.set(slider, { name, input, output });
    }
  }

  function change(values) {
    Object.assign(set.values, values);
    showSliders();
    update();
  }

  // --- the moment that is explained
  function go(place) {
    set.cursor = Math.min(Math.max(place, 0), shown.pass.questions.length - 1);
    drawPass();
    clearTimeout(waitsForLink);
    waitsForLink = setTimeout(writeLink, LINK_AFTER_MS);
  }

  function goToCommand(direction) {
    const { questions } = shown.pass;
    for (let place = set.cursor + direction; place >= 0 && place < questions.length; place += direction) {
      if (questions[place].question.wanted !== questions[place].question.before) return go(place);
    }
    return undefined;
  }

  function goToPointer(chart, coordinate) {
    return ({ offsetX }) => {
      const wanted = chart.xAt(offsetX), { questions } = shown.pass;
      const far = questions.map((each) => Math.abs(coordinate(each) - wanted));
      if (far.length > 0) go(far.indexOf(Math.min(...far)));
    };
  }

  // --- words of the drawings
  function key(id, entries) {
    at(id).replaceChildren(...entries.map(([colour, kind, text]) => {
      const entry = document.createElement("span"), mark = document.createElement("i");
      mark.className = kind;
      mark.style.color = `var(--${colour})`;
      entry.append(mark, text);
      return entry;
    }));
  }

  function showKeys() {
    key("speed-key", [["ink", "", "true speed"], ["radar", "ring", "radar"], ["estimate", "disc", "estimate, if the table has one"],
      ["upper", "", "upper line of the stage in force: raise above it"], ["lower", "dash", "lower line: lower below it"],
      ["soft", "thin", "thin: the same lines for the whole path, at the moment that is explained"],
      ["ink", "dots", "target"], ["zone", "fill", "retarders"]]);
    key("pressure-key", [["ink", "", "pressure in the cylinders"], ["upper", "dash", "pressure of the commanded stage"],
      ["soft", "dots", "the pads touch"]]);
    key("cloud-key", [["radar", "", "a cut each"], ["ink", "dots", "target"]]);
    key("histogram-key", [["radar", "fill", "cuts that left"], ["estimate", "disc", "mean and rms as the table tells"],
      ["upper", "dash", `${withUnit(overspeedMS, 1)} too fast`]]);
  }

  function showAll() {
    at("table").selectedIndex = set.choice;
    at("unit").value = set.unit;
    showSliders();
    showKeys();
    update();
  }

  // --- what the user does
  function pressed(event) {
    const { tagName, type } = event.target;
    if (tagName === "SELECT" || event.ctrlKey || event.metaKey || event.altKey) return;
    const acts = { n: () => goToCommand(1), p: () => goToCommand(-1), s: () => at("draw").click(), r: () => at("reset").click() };
    if (tagName !== "INPUT" || type !== "range") {
      acts.ArrowRight = () => go(set.cursor + 1);
      acts.ArrowLeft = () => go(set.cursor - 1);
    }
    if (!Object.hasOwn(acts, event.key)) return;
    event.preventDefault();
    acts[event.key]();
  }

  function listen() {
    on("table", "change", () => {
      Object.assign(set, { choice: at("table").selectedIndex, cursor: null });
      set.values = Controls.usual(plantOf());
      showAll();
    });
    on("unit", "change", () => {
      set.unit = at("unit").value;
      SpeedUnits.remember(set.unit);
      showAll();
    });
    on("draw", "click", () => change({ seed: set.values.seed % Controls.MOST_SEED + 1 }));
    on("reset", "click", () => { set.cursor = null; change(Controls.usual(plantOf())); });
    on("moment", "input", () => go(Number(at("moment").value)));
    on("back", "click", () => goToCommand(-1));
    on("on", "click", () => goToCommand(1));
    on("passes", "change", update);
    on("speed", "pointermove", goToPointer(charts.speed, ({ question }) => question.s));
    on("pressure", "pointermove", goToPointer(charts.pressure, ({ time }) => time));
    document.addEventListener("keydown", pressed);
    window.addEventListener("resize", update);
    window.addEventListener("hashchange", () => { readLink(); showAll(); });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", update);
  }

  for (const of of classes) {
    const made = new Map();
    of.made = (told) => { if (!made.has(told)) made.set(told, Rule.table(told.held)); return made.get(told); };
  }
  for (const { told } of choices) at("table").add(new Option(told.title));
  for (const unit of Object.keys(SpeedUnits.FACTORS)) at("unit").add(new Option(unit));
  makeSliders();
  listen();
  readLink();
  showAll();
})();
