"use strict";
// What is drawn: one pass on the lines of the stage in force, its pressure over time, many passes, and their exits.
const Pictures = (() => {
  const POINTS = 60, STAGE_ROOM = 54, RULE_DASH = [9, 3, 2, 3];
  const SIDES = [[Words.LOWER, "lower", [7, 3]], [Words.UPPER, "upper", []]];

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

  // The lines of the stage in force, and those for the whole path at the moment that is explained.
  function linesOf(chart, shown) {
    const { plant, table, pass, cursor } = shown, now = pass.questions[cursor]?.question;
    for (const [side, colour, dash] of SIDES) {
      for (const line of inForce(shown, side)) chart.line(line, colour, { width: 3, dash });
      if (!now) continue;
      const whole = [table.path_min_m, Math.min(table.path_max_m, plant.edges_m.at(-1))];
      chart.line(lineBetween(shown, now, now.before, side, whole, POINTS), colour, { width: 1, alpha: 0.6 });
    }
  }

  // The switching speeds next to the stage in force, a bar at each passage at which was decided; at the moment that is
  // explained all of them.
  function switchingOf(chart, shown) {
    const { table, room, pass, factor, cursor } = shown;
    pass.questions.forEach(({ question: { s, deciding, before, isAsked } }, place) => {
      if (deciding < 0 || !isAsked) return;
      for (const [speed, wanted] of PassageWords.switching(table, room, deciding, before)) {
        if (place !== cursor && Math.abs(wanted - before) !== 1) continue;
        chart.bar(s, speed * factor, wanted < before ? "lower" : "upper", wanted < before);
      }
    });
  }

  function speedOverPath(chart, shown) {
    const { plant, pass, rulePass, table, factor, unit, cursor } = shown, { questions } = pass, end = plant.edges_m.at(-1);
    const speeds = [pass, rulePass].flatMap((each) => each ? each.points.map(([, v]) => v) : []);
    const highest = Math.max(...speeds, shown.targetMS) * 1.15, now = questions[cursor]?.question;
    chart.begin({ x: [plant.edges_m[0], end], y: [0, highest * factor], titles: ["path of the first axle, m", unit] });
    for (const zone of plant.zones_m) chart.band(zone, [null, null], "zone");
    (plant.sensor.passages ? switchingOf : linesOf)(chart, shown);
    for (const place of plant.sensor.path_m ?? []) chart.foot(place, "soft");
    if (now) chart.upright(now.s, "soft", [2, 3]);
    chart.line([[plant.edges_m[0], shown.targetMS * factor], [end, shown.targetMS * factor]], "ink", { width: 1, dash: [1, 4] });
    chart.dots(questions.filter(({ question }) => question.measured >= 0)
      .map(({ question }) => [question.s, question.measured * factor]), "radar", { hollow: true });
    if (table.breaks > 0) {
      chart.dots(questions.map(({ question }) => [question.s, question.known * factor]), "estimate", { radius: 2 });
    }
    chart.line(scaled(pass, factor), "ink", { width: 2 });
    if (rulePass) chart.line(scaled(rulePass, factor), "rule", { width: 2, dash: RULE_DASH });
    if (now) chart.dots([[now.s, questions[cursor].v * factor]], "ink", { radius: 5 });
  }

  const scaled = ({ points }, factor) => points.map(([s, v]) => [s, v * factor]);

  function pressureOverTime(chart, shown) {
    const { plant, pass, rulePass, cursor } = shown, { questions } = pass, top = plant.stage_kpa.at(-1) * 1.08 + 1;
    const end = Math.max(pass.exit.time, rulePass?.exit.time ?? 0);
    chart.begin({ x: [0, end], y: [0, top], titles: ["time, s", "kPa"], room: STAGE_ROOM });
    chart.line([[0, plant.valves.touch_kpa], [end, plant.valves.touch_kpa]], "soft", { width: 1, dash: [1, 4] });
    const wanted = [[0, plant.stage_kpa[plant.initial_stage]]];
    for (const { time, question } of questions) {
      wanted.push([time, wanted.at(-1)[1]], [time, plant.stage_kpa[question.wanted]]);
    }
    wanted.push([pass.exit.time, wanted.at(-1)[1]]);
    chart.line(wanted, "upper", { width: 2, dash: [7, 3] });
    chart.line(pass.pressures, "ink", { width: 2 });
    if (rulePass) chart.line(rulePass.pressures, "rule", { width: 2, dash: RULE_DASH });
    for (const [stage, kpa] of plant.stage_kpa.entries()) chart.wordBehind(`stage ${stage}`, kpa, "soft");
    if (questions[cursor]) chart.upright(questions[cursor].time, "soft", [2, 3]);
  }

  // Speed over path of all cuts, `highestMS` being that of the chart beside it too.
  function cloud(chart, shown, passes, { colour, highestMS }) {
    const { plant, factor, unit } = shown, titles = ["path of the first axle, m", unit];
    chart.begin({ x: [plant.edges_m[0], plant.edges_m.at(-1)], y: [0, highestMS * factor], titles });
    for (const zone of plant.zones_m) chart.band(zone, [null, null], "zone");
    chart.lines(passes.map((pass) => scaled(pass, factor)), colour, { alpha: passes.length > 200 ? 0.12 : 0.35 });
    const target = shown.targetMS * factor;
    chart.line([[plant.edges_m[0], target], [plant.edges_m.at(-1), target]], "ink", { width: 1, dash: [1, 4] });
  }

  // Exit errors of the cuts that have left, in bins of `Histogram`, and what the density of the case makes of so many.
  function histogram(chart, shown, { counts, spreadMS, mostCuts }, { colour, expected, overspeedMS }) {
    const { factor, unit } = shown, width = 2 * spreadMS / counts.length, titles = [`exit error, ${unit}`, "cuts"];
    chart.begin({ x: [-spreadMS * factor, spreadMS * factor], y: [0, mostCuts * 1.1], titles });
    counts.forEach((count, bin) => {
      const from = (-spreadMS + bin * width) * factor;
      chart.band([from + 0.06 * width * factor, from + 0.94 * width * factor], [0, count], colour, 0.75);
    });
    chart.line(expected.map(([error, cuts]) => [error * factor, cuts]), "ink", { width: 2 });
    chart.upright(0, "ink", [1, 4]);
    if (overspeedMS < spreadMS) chart.upright(overspeedMS * factor, "upper", [7, 3]);
  }

  return { speedOverPath, pressureOverTime, cloud, histogram };
})();
