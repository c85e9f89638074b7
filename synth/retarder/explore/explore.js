"use strict";
// The page: what is set, one pass of it at once, then many. All data are in the element "data"; nothing is loaded.
(() => {
  const { classes, overspeed_m_s: overspeedMS, alarms } = JSON.parse(document.getElementById("data").textContent);
  const LINK_AFTER_MS = 250, MANY_AFTER_MS = 200, SOON_MS = 0, FEW_PASSES = 100, ONE_PASS = 0;
  const at = (id) => document.getElementById(id);
  const on = (id, event, act) => at(id).addEventListener(event, act);
  const choices = classes.flatMap((of) => of.tables.map((told) => ({ of, told })));
  const charts = Object.fromEntries([...document.querySelectorAll("canvas")].map((each) => [each.id, new Chart(each)]));
  const set = { choice: 0, values: null, cursor: null, unit: "m/s" };
  let shown = null, waitsForCloud = 0, waitsForLink = 0;

  const plantOf = () => choices[set.choice].of.plant;
  const number = (m_s, digits = 2) => (m_s * SpeedUnits.FACTORS[set.unit]).toFixed(digits);
  const withUnit = (m_s, digits = 2) => `${number(m_s, digits)} ${set.unit}`;
  function signed(m_s) {
    const size = number(Math.abs(m_s));
    return `${Number(size) === 0 ? "" : m_s < 0 ? "−" : "+"}${size}`;
  }

  // --- passes
  // The regulators of a table: its own, and that of the rule beside it, null where there is none.
  function regulatorsOf({ of: { plant }, told }) {
    const table = (Controls.isRadar(plant) ? Rule : PassageRule).table(told.held);
    const own = Controls.isRadar(plant) ? Laws.byTable(plant, table) : Passages.byTable(plant, table);
    return { table, own, rule: told.rule && Laws.byLines(plant, told.rule.lines) };
  }

  // What plays cuts under a regulator with the sliders as they are; of a cut that is explained it keeps everything.
  function playerOf(plant, regulator) {
    const { mass: massT, noise: noiseMS, timer, delay } = set.values, { run } = Controls.isRadar(plant) ? Passes : Passages;
    const drive = Drive.drive(plant, regulator.atAnyTime, delay), setting = { massT, noiseMS, noiseS: timer * 1e-3, drive };
    return (cut, isExplained) => {
      const questions = [], points = [], pressures = [];
      const exit = run(plant, regulator, setting, cut, (time, s, v, _kpa, _stage, question) => {
        points.push([s, v]);
        if (!isExplained) return;
        if (question) questions.push({ time, v, question });
        if (drive.pressureAt) pressures.push([time, drive.pressureAt(time)]);
        else if (question) pressures.push([time, question.pressureKpa]);
      });
      points.push([exit.s, exit.stalled ? 0 : exit.exitMS]);
      return { exit, questions, points, pressures };
    };
  }

  // The one pass of the sliders, and everything that is drawn of it.
  function update() {
    const choice = choices[set.choice], { of: { plant, room }, told } = choice, { values } = set;
    choice.regulators ??= regulatorsOf(choice);
    const { table, own, rule } = choice.regulators;
    const cut = { ...Draws.cut(plant, values.seed, ONE_PASS), entryMS: values.entry, factor: values.factor,
      resistance: values.resistance };
    const pass = playerOf(plant, own)(cut, true), rulePass = rule && playerOf(plant, rule)(cut, true);
    shown = { plant, room, table, told, pass, rulePass, targetMS: told.target_m_s };
    const first = pass.questions.findIndex(({ question }) => question.wanted !== question.before);
    if (set.cursor === null) set.cursor = Math.max(0, first);
    set.cursor = Math.min(set.cursor, pass.questions.length - 1);
    tellExit("exit", pass);
    if (rulePass) tellExit("rule-exit", rulePass);
    drawPass();
    clearTimeout(waitsForCloud);
    waitsForCloud = setTimeout(manyPasses, Number(at("passes").value) > FEW_PASSES ? MANY_AFTER_MS : SOON_MS);
    clearTimeout(waitsForLink);
    waitsForLink = setTimeout(writeLink, LINK_AFTER_MS);
  }

  function tellExit(id, { exit }) {
    const error = exit.exitMS - shown.targetMS, commands = `${exit.commands} command${exit.commands === 1 ? "" : "s"}`;
    at(id).className = !exit.stalled && error > overspeedMS ? "fast" : "";
    at(id).textContent = exit.stalled ? "The cut stands" : `Error ${signed(error)} ${set.unit}`;
    at(`${id}-more`).textContent = exit.stalled ? `at ${exit.s.toFixed(1)} m after ${exit.time.toFixed(1)} s; ${commands}`
      : `exit ${withUnit(exit.exitMS)}, target ${withUnit(shown.targetMS)}; ${commands}, ${exit.time.toFixed(1)} s`;
  }

  function drawPass() {
    Object.assign(shown, { cursor: set.cursor, factor: SpeedUnits.FACTORS[set.unit], unit: set.unit });
    Pictures.speedOverPath(charts.speed, shown);
    Pictures.pressureOverTime(charts.pressure, shown);
    const moment = shown.pass.questions[set.cursor], slider = at("moment");
    slider.max = shown.pass.questions.length - 1;
    slider.value = set.cursor;
    const sentences = moment ? whyOf(moment) : ["The pass ended before the first sample."];
    at("why").replaceChildren(...sentences.map((textContent) => Object.assign(document.createElement("li"), { textContent })));
  }

  const whyOf = (moment) => Controls.isRadar(shown.plant) ? Words.why(shown.plant, shown.table, moment, withUnit, alarms)
    : PassageWords.why(shown.plant, shown.table, shown.room, moment, withUnit);

  // Many cuts under the table and under the rule: { title, colour, simulated, passes } of each.
  function manyPasses() {
    const { plant, told } = shown, count = Number(at("passes").value), { own, rule } = choices[set.choice].regulators;
    const cuts = Array.from({ length: count }, (_, place) => Draws.cut(plant, set.values.seed, ONE_PASS + 1 + place));
    const played = [{ regulator: own, name: "this table", colour: "radar", simulated: told.simulated, of: ["cloud", "histogram"] }];
    if (rule) {
      const of = ["rule-cloud", "rule-histogram"];
      played.push({ regulator: rule, name: told.rule.name, colour: "rule", simulated: told.rule.simulated, of });
    }
    for (const each of played) {
      const play = playerOf(plant, each.regulator);
      each.passes = cuts.map((cut) => play(cut, false));
      each.exits = each.passes.map(({ exit }) => exit);
    }
    at("count").textContent = count;
    drawMany(played);
    tellMany(played);
    at("differs").textContent = Controls.isConfigured(plant, set.values) ? ""
      : "Mass, noise or delays are not those of the configuration: densities and simulated passes are not of this plant.";
  }

  function drawMany(played) {
    const speeds = played.flatMap(({ passes }) => passes.flatMap(({ points }) => points.map(([, v]) => v)));
    const highestMS = 1.05 * speeds.reduce((most, each) => Math.max(most, each), 0);
    const bins = Histogram.of(played.map(({ exits }) => exits), played.map(({ simulated }) => simulated.density), shown.targetMS);
    played.forEach(({ passes, colour, of: [cloud, histogram] }, place) => {
      Pictures.cloud(charts[cloud], shown, passes, { colour, highestMS });
      Pictures.histogram(charts[histogram], shown, bins[place], { colour, expected: bins[place].expected, overspeedMS });
    });
  }

  function tellMany(played) {
    const [own, rule] = played.map(({ exits }) => exits), { n } = shown.told.simulated, { targetMS } = shown;
    const figures = {
      here: played.map(({ exits }) => Figures.of(exits, targetMS, overspeedMS)),
      simulated: played.map(({ simulated }) => simulated),
      nearer: rule && Figures.nearer(own, rule, targetMS),
      overspeedMS,
    };
    const titles = [`${own.length} cuts here`, `${n} simulated`].flatMap((title) => played.map(({ name }) => `${name}, ${title}`));
    FigureTable.show(at("figure-head"), at("figures"), titles, FigureTable.rows(figures, { unit: set.unit, number, withUnit }));
  }

  // --- the state and its link
  function writeLink() {
    const others = { unit: set.unit, at: set.cursor, cuts: at("passes").value };
    const link = Controls.link(plantOf(), choices[set.choice].told.id, set.values, others);
    try { history.replaceState(null, "", link); } catch { return; }  // a browser may refuse it for a file
  }

  function readLink() {
    const words = Controls.asked(), found = choices.findIndex(({ told }) => told.id === words.get("table"));
    set.choice = Math.max(0, found);
    set.values = Controls.valuesAsked(plantOf(), words);
    set.unit = SpeedUnits.known(words.get("unit")) ? words.get("unit") : SpeedUnits.remembered();
    const cuts = [...at("passes").options].findIndex(({ value }) => value === words.get("cuts"));
    at("passes").selectedIndex = Math.max(0, cuts);
    const moment = Number(words.get("at") ?? NaN);
    set.cursor = Number.isInteger(moment) && moment >= 0 && words.has("at") ? moment : null;
  }

  // --- sliders
  const sliders = new Map();
  function showSliders() {
    const plant = plantOf();
    for (const [slider, { row, name, input, output }] of sliders) {
      row.hidden = !Controls.slidersOf(plant).includes(slider);
      if (row.hidden) continue;
      const { key, label, isSpeed, range, step, digits } = slider;
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
      sliders.set(slider, { row, name, input, output });
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

  function showAll() {
    at("table").selectedIndex = set.choice;
    at("unit").value = set.unit;
    showSliders();
    Legends.show(choices[set.choice], { overspeedMS, withUnit });
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

  for (const { told } of choices) at("table").add(new Option(told.title));
  for (const unit of Object.keys(SpeedUnits.FACTORS)) at("unit").add(new Option(unit));
  makeSliders();
  listen();
  readLink();
  showAll();
})();
