"use strict";
// One pass of a cut through the position: the radar reads, the rule decides, the drive follows, the cut moves on.
const Passes = (() => {
  // What the radar shows of a speed; `z` is its noise in standard deviations, NaN for a lost reading.
  function measure(sensor, noiseMS, v, z) {
    let shown = v + noiseMS * z;
    if (sensor.resolution_m_s > 0) shown = Drive.rint(shown / sensor.resolution_m_s) * sensor.resolution_m_s;
    return shown < 0 ? 0 : shown;
  }

  // The stage that the position lets a regulator command.
  const admitted = (plant, stage, wanted, s) => s < 0 ? Math.min(wanted, Math.max(stage, plant.entrance_stage)) : wanted;

  // A regulator of one cut: an estimate if the table has one, the stage commanded last, and its question at a sample.
  class Regulator {
    constructor(plant, table) {
      Object.assign(this, { plant, table, estimate: Rule.estimate(), stage: plant.initial_stage, passedKpa: 0 });
    }

    // Everything about the question at a sample, for the words; `isAsked` false: a change of stage is under way.
    ask(s, measured, pressureKpa, isAsked) {
      const { table, stage, plant } = this;
      const known = table.breaks > 0 ? Rule.observe(table, this.estimate, s, measured, this.passedKpa) : measured;
      const told = { s, measured, known, pressureKpa, isAsked, before: stage, wanted: stage };
      told.alarms = table.breaks > 0 ? Rule.alarms(table, this.estimate) : 0;
      if (isAsked) told.wanted = admitted(plant, stage, Rule.decide(table, stage, s, known, pressureKpa), s);
      this.stage = told.wanted;
      return told;
    }
  }

  // Runs a pass. `cut`: factor, resistance, entryMS, phase, pathZ, noiseZ. `setting`: massT, noiseMS, and a `drive`.
  // `note`, if given, is told every piece: (time, s, v, overpressure, stage, question at its beginning or null).
  function run(plant, table, setting, cut, note = null) {
    const { sensor } = plant, { drive } = setting, path = Motion.cells(plant, setting.massT, cut);
    const at = { cell: 0, s: path.edges[0], v: Motion.startSpeed(plant, path, cut.entryMS) };
    const first = cut.phase * sensor.period_s, longest = Math.trunc(plant.longest_pass_s / sensor.period_s);
    const regulator = new Regulator(plant, table);
    let commands = 0, began = 0, pieces = [{ kpa: drive.overpressureKpa, seconds: first }], question = null;
    for (let sample = -1; ; sample++) {
      if (sample >= 0) {
        began = first + sample * sensor.period_s;
        if (sample >= longest && drive.isAsked) return ended(began, at, true, commands);
        const measured = measure(sensor, setting.noiseMS, at.v, cut.noiseZ[sample % cut.noiseZ.length]);
        question = regulator.ask(at.s, measured, drive.pressureKpa, drive.isAsked);
        if (question.wanted !== question.before) commands += 1;
        const played = drive.play(question.wanted);
        pieces = played.pieces;
        regulator.passedKpa = played.meanKpa;
      }
      for (const { kpa, seconds } of pieces) {
        if (note) note(began, at.s, at.v, kpa, regulator.stage, question);
        question = null;
        const [how, used] = Motion.advance(path, at, kpa, seconds);
        if (how !== Motion.MOVES) return ended(began + used, at, how === Motion.STANDS, commands);
        began += seconds;
      }
    }
  }

  const ended = (time, at, stalled, commands) => ({ time, s: at.s, exitMS: stalled ? 0 : at.v, stalled, commands });

  // A pass with the drive made ready.
  function runFrom(plant, table, setting, cut, note) {
    setting.drive.begin();
    return run(plant, table, setting, cut, note);
  }

  return { run: runFrom };
})();
