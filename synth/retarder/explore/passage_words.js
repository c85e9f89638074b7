"use strict";
// Why a regulator with point sensors commands what it commands at a pair of pulses, in sentences.
const PassageWords = (() => {
  const MOST_M_S = 1e6;  // a controller holds a greater number where a stage is never left so

  const isGated = (table, passage) => passage < table.before_entrance && table.entrance_stage < table.stages - 1;

  // Switching speeds of a stage at a passage at which is decided: [speed, stage wanted beyond it], from slow to fast.
  function switching(table, room, passage, stage) {
    const first = (passage * room.stages + stage) * room.thresholds, found = [];
    const highest = isGated(table, passage) ? table.entrance_stage : table.stages - 1;
    for (let threshold = 0; threshold < Math.max(stage, highest); threshold++) {
      const speed = table.switching_m_s[first + threshold];
      if (Math.abs(speed) <= MOST_M_S) found.push([speed, threshold < stage ? threshold : threshold + 1]);
    }
    return found;
  }

  function switchingTold(table, room, { deciding, before }, withUnit) {
    const told = switching(table, room, deciding, before).map(([speed, wanted]) =>
      `stage ${wanted} ${wanted < before ? "below" : "above"} ${withUnit(speed)}`);
    const gate = isGated(table, deciding) ? `, but before the entrance none above stage ${table.entrance_stage}` : "";
    return `Stage ${before} is in force. At this passage the table wants ${told.join(", ") || "no other stage"}${gate}.`;
  }

  // As `Words.why`; `room`: the lengths of the axes of the table's arrays.
  function why(plant, table, room, { time, v, question }, withUnit) {
    const { s, sensor, axle, measured, known, heard, passage, deciding, isAsked, before, wanted, pressureKpa } = question;
    const place = plant.sensor.path_m[sensor].toFixed(2).replace("-", "−");
    const told = [`${time.toFixed(2)} s: axle ${axle + 1} has rolled over sensor ${sensor + 1} at ${place} m; the first ` +
      `axle is at ${s.toFixed(2).replace("-", "−")} m, ${Words.where(plant, s)}.`];
    told.push(`Between the two pulses it had ${withUnit(measured)} by the sensor; the true speed is ${withUnit(v)} now.`);
    if (heard < 0) told.push("The tracker does not believe the pair: nothing is asked.");
    else if (heard !== passage) told.push(`The tracker takes it for passage ${heard + 1} of the cut; it is passage ${passage + 1}.`);
    else told.push(`The tracker takes it for what it is, passage ${passage + 1} of the cut.`);
    if (heard >= 0 && deciding < 0) told.push("At this passage nothing is decided.");
    if (deciding >= 0 && !isAsked) {
      told.push(`The change to stage ${before} was under way, with ${pressureKpa.toFixed(0)} kPa in the cylinders now: ` +
        "nothing is asked before it has ended.");
    }
    if (deciding >= 0 && isAsked) told.push(switchingTold(table, room, question, withUnit));
    if (deciding >= 0 && isAsked && !(known >= 0)) told.push("Without a speed the rule holds.");
    told.push(Words.commanded(plant, before, wanted));
    return told;
  }

  return { switching, why };
})();
