"use strict";
// Why a regulator commands what it commands at a sample, in sentences. The rule itself is asked for every step.
const Words = (() => {
  const LOWER = 0, UPPER = 1;

  // What the pressure adds to a line of the stage that is asked first.
  function rise(table, { before, pressureKpa }, side) {
    if (table.has_gauge !== 1) return 0;
    return Math.fround(table.slope[before * 2 + side] * Rule.pressure_above(table, before, Math.fround(pressureKpa)));
  }

  // The line of a stage at a path; null where there is none.
  function line(table, question, stage, side, s) {
    if (table.has_line[stage * 2 + side] !== 1) return null;
    const place = Math.min(Math.max(Math.fround(s), table.path_min_m), table.path_max_m);
    return Math.fround(Rule.line_speed(table, stage, side, place) + rise(table, question, side));
  }

  // The stages that the rule looks at, one after the other, each with its lines and its answer: -1, 0 or 1.
  function steps(table, question) {
    const place = Math.min(Math.max(Math.fround(question.s), table.path_min_m), table.path_max_m);
    const speed = Math.fround(question.known), last = question.wanted, found = [];
    for (let stage = question.before; ; stage += Math.sign(last - question.before)) {
      const rises = [LOWER, UPPER].map((side) => rise(table, question, side));
      const answer = Rule.answer_at(table, stage, place, speed, ...rises);
      const [lower, upper] = [LOWER, UPPER].map((side) => line(table, question, stage, side, question.s));
      found.push({ stage, lower, upper, answer });
      if (stage === last) return found;
    }
  }

  function where(plant, s) {
    if (s < 0) return "before the entrance";
    const zone = plant.zones_m.findIndex(([begin, end]) => s >= begin && s < end);
    if (zone >= 0) return plant.zones_m.length === 1 ? "in the retarder" : `in retarder ${zone + 1}`;
    return s > plant.zones_m.at(-1)[1] ? "behind the last retarder" : "between two retarders";
  }

  // Why the rule goes no further from a stage that answers lower or raise.
  function heldBy(table, question, answer) {
    const moved = Math.sign(question.wanted - question.before);
    if (moved === -answer) return "but the rule has just come from there: hold";
    if (moved === answer && table.at_any_time === 1) return "but one command goes one stage: the next sample asks again";
    return "but no such stage may be commanded here: hold";
  }

  function stepTold(table, question, { stage, lower, upper, answer }, withUnit) {
    const lines = [];
    if (lower !== null) lines.push(`lower line ${withUnit(lower)}`);
    if (upper !== null) lines.push(`upper line ${withUnit(upper)}`);
    const told = `Stage ${stage}${stage === question.before ? " is in force" : ""}: ${lines.join(", ") || "no line"}.`;
    if (answer === 0) {
      const gated = question.s < 0 && upper !== null && question.known > upper;
      if (gated) return `${told} The speed is above it, but no higher stage may be commanded before the entrance: hold.`;
      const beyond = lower === null ? "not above the upper line" : upper === null ? "not below the lower line"
        : "neither below the lower nor above the upper line";
      return lines.length === 0 ? `${told} Hold.` : `${told} The speed is ${beyond}: hold.`;
    }
    const found = answer < 0 ? "below the lower line" : "above the upper line";
    const ends = stage === question.wanted ? heldBy(table, question, answer) : answer < 0 ? "go a stage down" : "go a stage up";
    return `${told} The speed is ${found}: ${ends}.`.replace(": but", ", but");
  }

  // [sentence, …] for a question of a regulator at time `time`; `alarms`: bits of the alarm word and what they mean.
  function why(plant, table, { time, v, question }, withUnit, alarms) {
    const { s, measured, known, before, wanted, isAsked, pressureKpa } = question;
    const told = [`${time.toFixed(2)} s: the first axle is at ${s.toFixed(2).replace("-", "−")} m, ${where(plant, s)}.`];
    told.push(Number.isNaN(measured) ? `The radar gives no reading; the true speed is ${withUnit(v)}.`
      : `The radar shows ${withUnit(measured)}; the true speed is ${withUnit(v)}.`);
    if (table.breaks > 0) {
      told.push(known < 0 ? "The estimator has no speed yet." : `The estimator makes ${withUnit(known)} of all readings.`);
    }
    for (const [bit, meaning] of alarms) {
      if (question.alarms & bit) told.push(`${meaning[0].toUpperCase()}${meaning.slice(1)}.`);
    }
    if (!isAsked) {
      told.push(`The change to stage ${before} is under way, with ${pressureKpa.toFixed(0)} kPa in the cylinders. This ` +
        "table decides at rest: nothing is asked before the change has ended.");
      return told;
    }
    if (!(known >= 0)) {
      told.push("Without a speed the rule holds.");
    } else {
      for (const step of steps(table, question)) told.push(stepTold(table, question, step, withUnit));
    }
    told.push(commanded(plant, before, wanted));
    return told;
  }

  const commanded = (plant, before, wanted) => wanted === before ? "So nothing is commanded."
    : `So stage ${wanted} is commanded, ${plant.stage_kpa[wanted].toFixed(0)} kPa.`;

  return { LOWER, UPPER, line, steps, where, commanded, why };
})();
