"use strict";
// What is drawn: one pass on the lines of the stage in force, its pressure over time, many passes, and their exits.
const Pictures = (() => {
  const BINS = 24, LEAST_SPREAD_M_S = 0.1, POINTS = 60, STAGE_ROOM = 54;

  // Path and speeds of a line of a stage between two places, in the unit that is shown.
  function lineBetween(shown, question, stage, side, [from, to], points) {
    const found = [];
    for (let place = 0; place <= points; place++) {
      const s = from + (to - from) * place / points;
      const speed = Words.line(shown.table, question, stage, side, s);
      if (speed === null) return [];
      found.push([s, speed * shown.factor]);
    }
    return found;
  }

  // The line of the stage in force along the pass, a piece from one change of stage to the next.
  function inForce(shown, side) {
    const { questions, exit } = shown.pass, found = [];
    questions.forEach(({ question }, place) => {
      const span = [question.s, questions[place + 1]?.question.s ?? exit.s];
      const piece = lineBetween(shown, question, question.before, side, span, 1);
      if (place > 0 && questions[place - 1].question.before === question.before) found.at(-1).push(...piece);
      else found.push(piece);
    });
    return found;
  }

  function speedOverPath(chart, shown) {
    const { plant, pass, table, factor, unit, cursor } = shown, { questions } = pass, end = plant.edges_m.at(-1);
    const highest = Math.max(...pass.points.map(([, v]) => v), shown.targetMS) * 1.15;
    chart.begin({ x: [plant.edges_m[0], end], y: [0, highest * factor], titles: ["path of the first axle, m", unit] });
    for (const zone of plant.zones_m) chart.band(zone, [null, null], "zone");
    const sides = [[Words.LOWER, "lower", [7, 3]], [Words.UPPER, "upper", []]];
    for (const [side, colour, dash] of sides) {
      for (const line of inForce(shown, side)) chart.line(line, colour, { width: 3, dash });
    }
    const now = questions[cursor]?.question;
    if (now) {
      for (const [side, colour] of sides) {
        const whole = [table.path_min_m, Math.min(table.path_max_m, end)];
        chart.line(lineBetween(shown, now, now.before, side, whole, POINTS), colour, { width: 1, alpha: 0.6 });
      }
      chart.upright(now.s, "soft", [2, 3]);
    }
    chart.line([[plant.edges_m[0], shown.targetMS * factor], [end, shown.targetMS * factor]], "ink", { width: 1, dash: [1, 4] });
    chart.dots(questions.filter(({ question }) => question.measured >= 0)
      .map(({ question }) => [question.s, question.measured * factor]), "radar", { hollow: true });
    if (table.breaks > 0) {
      chart.dots(questions.map(({ question }) => [question.s, question.known * factor]), "estimate", { radius: 2 });
    }
    chart.line(pass.points.map(([s, v]) => [s, v * factor]), "ink", { width: 2 });
    if (now) chart.dots([[now.s, questions[cursor].v * factor]], "ink", { radius: 5 });
  }

  function pressureOverTime(chart, shown) {
    const { plant, pass, cursor } = shown, { questions } = pass, top = plant.stage_kpa.at(-1) * 1.08 + 1;
    chart.begin({ x: [0, pass.exit.time], y: [0, top], titles: ["time, s", "kPa"], room: STAGE_ROOM });
    chart.line([[0, plant.valves.touch_kpa], [pass.exit.time, plant.valves.touch_kpa]], "soft", { width: 1, dash: [1, 4] });
    const wanted = [[0, plant.stage_kpa[plant.initial_stage]]];
    for (const { time, question } of questions) {
      wanted.push([time, wanted.at(-1)[1]], [time, plant.stage_kpa[question.wanted]]);
    }
    wanted.push([pass.exit.time, wanted.at(-1)[1]]);
    chart.line(wanted, "upper", { width: 2, dash: [7, 3] });
    chart.line(questions.map(({ time, question }) => [time, question.pressureKpa]), "ink", { width: 2 });
    for (const [stage, kpa] of plant.stage_kpa.entries()) chart.wordBehind(`stage ${stage}`, kpa, "soft");
    if (questions[cursor]) chart.upright(questions[cursor].time, "soft", [2, 3]);
  }

  function cloud(chart, shown, passes) {
    const { plant, factor, unit } = shown;
    const highest = Math.max(...passes.map(({ points }) => Math.max(...points.map(([, v]) => v)))) * 1.05;
    const titles = ["path of the first axle, m", unit];
    chart.begin({ x: [plant.edges_m[0], plant.edges_m.at(-1)], y: [0, highest * factor], titles });
    for (const zone of plant.zones_m) chart.band(zone, [null, null], "zone");
    const all = passes.map(({ points }) => points.map(([s, v]) => [s, v * factor]));
    chart.lines(all, "radar", { alpha: passes.length > 200 ? 0.12 : 0.35 });
    const target = shown.targetMS * factor;
    chart.line([[plant.edges_m[0], target], [plant.edges_m.at(-1), target]], "ink", { width: 1, dash: [1, 4] });
  }

  // Exit errors of the passes that have left; a bracket from mean - rms to mean + rms of the table's own figures.
  function histogram(chart, shown, exits, told, overspeedMS) {
    const { factor, unit } = shown;
    const errors = exits.filter(({ stalled }) => !stalled).map(({ exitMS }) => exitMS - shown.targetMS);
    const own = Math.abs(told.bias_m_s) + told.rms_m_s;
    const spread = Math.max(LEAST_SPREAD_M_S, own, ...errors.map(Math.abs)) * 1.05, width = 2 * spread / BINS;
    const counts = new Array(BINS).fill(0);
    for (const each of errors) counts[Math.min(BINS - 1, Math.floor((each + spread) / width))] += 1;
    const most = Math.max(...counts, 1) * 1.25;
    chart.begin({ x: [-spread * factor, spread * factor], y: [0, most], titles: [`exit error, ${unit}`, "passes"] });
    counts.forEach((count, bin) => {
      const from = (-spread + bin * width) * factor;
      chart.band([from + 0.06 * width * factor, from + 0.94 * width * factor], [0, count], "radar");
    });
    chart.upright(0, "ink", [1, 4]);
    if (overspeedMS < spread) chart.upright(overspeedMS * factor, "upper", [7, 3]);
    const [low, high] = [told.bias_m_s - told.rms_m_s, told.bias_m_s + told.rms_m_s].map((each) => each * factor);
    const at = most * 0.93;
    chart.line([[low, at], [high, at]], "estimate", { width: 3 });
    chart.dots([[told.bias_m_s * factor, at]], "estimate", { radius: 5 });
  }

  return { speedOverPath, pressureOverTime, cloud, histogram };
})();
