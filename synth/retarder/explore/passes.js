"use strict";
// One pass of a cut that a radar sees: it reads, the regulator decides, the drive follows, the cut moves on.
const Passes = (() => {
  // What the radar shows of a speed; `z` is its noise in standard deviations, NaN for a lost reading.
  function measure(sensor, noiseMS, v, z) {
    let shown = v + noiseMS * z;
    if (sensor.resolution_m_s > 0) shown = Drive.rint(shown / sensor.resolution_m_s) * sensor.resolution_m_s;
    return shown < 0 ? 0 : shown;
  }

  // `regulator`: of `Laws`. `cut`: factor, resistance, entryMS, phase, pathZ, noiseZ. `setting`: massT, noiseMS, `drive`.
  // `note`, if given, is told every piece: (time, s, v, overpressure, stage, question at its beginning or null).
  function run(plant, regulator, setting, cut, note = null) {
    const { sensor } = plant, { drive } = setting, path = Motion.cells(plant, setting.massT, cut);
    const at = { cell: 0, s: path.edges[0], v: Motion.startSpeed(plant, path, cut.entryMS) };
    const first = cut.phase * sensor.period_s, longest = Math.trunc(plant.longest_pass_s / sensor.period_s);
    regulator.begin();
    drive.begin();
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

  return { run, ended };
})();
