"use strict";
// One pass of a cut over point sensors (synth.kernels.loop.passage_loop): a pair of pulses of every axle over every
// sensor, a regulator that tracks the cut and decides at the pairs, a drive that goes on by itself, and the cut.
const Passages = (() => {
  const { ended } = Passes;

  // The regulator of a table for point sensors.
  class Regulator {
    constructor(plant, table) { Object.assign(this, { plant, table, atAnyTime: false }); }

    begin() {
      Object.assign(this, { tracker: PassageRule.tracker(), stage: this.plant.initial_stage });
      PassageRule.begin_cut(this.tracker);
    }

    // Everything about a pair of pulses, for the words; `isAsked` false: a change of stage was under way.
    hear(pair, sinceS, isAsked) {
      const { table, tracker, stage } = this;
      const [heard, known] = PassageRule.hear(table, tracker, pair.sensor, sinceS, pair.overS);
      const wanted = PassageRule.stage_after(table, heard, stage, known, isAsked);
      this.stage = wanted;
      const deciding = heard < 0 ? -1 : table.deciding[heard];
      return { ...pair, heard, deciding, known, isAsked, before: stage, wanted, alarms: 0 };
    }
  }

  // Where the first axle is at each pulse, in the order of the path: { passage, isSecond, place }.
  function coils({ passages, coils: order, base_m: base, base_tolerance: tolerance, base_column: column,
    shortest_base: shortest }, noiseZ) {
    return order.map((coil) => {
      const isSecond = coil >= passages.length, passage = isSecond ? coil - passages.length : coil;
      const { path_m: path, sensor } = passages[passage];
      const scale = Math.max(1 + tolerance * noiseZ[column - sensor], shortest), half = 0.5 * base * scale;
      return { passage, isSecond, place: isSecond ? path + half : path - half };
    }).sort((one, other) => one.place - other.place);
  }

  // The measured time over a base.
  function measured(sensor, noiseS, trueS, z) {
    const time = trueS + noiseS * z, step = sensor.timer_resolution_s;
    return step > 0 ? Drive.rint(time / step) * step : time;
  }

  // Times at which first coils were passed before the pass begins; nothing brakes there.
  function passedBefore(met, path, v, firstS) {
    let next = 0;
    for (; next < met.length && met[next].place < path.edges[0]; next++) {
      const way = path.edges[0] - met[next].place;
      const before = Math.sqrt(Math.max(v * v - 2 * path.free[0] * way, 0.01 * v * v));
      firstS[met[next].passage] = -2 * way / (v + before);
    }
    return next;
  }

  // As `Passes.run`; of `setting` noiseS is the noise of the timer. A question is told at the pair that it is of.
  function run(plant, regulator, setting, cut, note = null) {
    const { sensor } = plant, { drive } = setting, path = Motion.cells(plant, setting.massT, cut);
    const at = { cell: 0, s: path.edges[0], v: Motion.startSpeed(plant, path, cut.entryMS) };
    const met = coils(sensor, cut.noiseZ), firstS = new Float64Array(sensor.passages.length), waiting = [];
    regulator.begin();
    drive.begin();
    let next = passedBefore(met, path, at.v, firstS), time = 0, heardS = sensor.watched_from_s, commands = 0;
    const tell = (when, question) => { if (note) note(when, at.s, at.v, drive.pieceKpa, regulator.stage, question); };
    tell(time, null);
    for (;;) {
      const pair = waiting.reduce((least, each) => (least === null || each.dueS < least.dueS ? each : least), null);
      const pieceEndsS = drive.pieceEndsS, untilS = Math.min(pieceEndsS, pair?.dueS ?? Infinity, plant.longest_pass_s);
      const toM = next < met.length ? met[next].place : Infinity;
      const [how, used] = Motion.advance(path, at, drive.pieceKpa, Math.max(0, untilS - time), toM);
      if (how === Motion.LEFT || how === Motion.STANDS) return ended(time + used, at, how === Motion.STANDS, commands);
      if (how === Motion.THERE) {
        time += used;
        const { passage, isSecond } = met[next];
        next += 1;
        if (isSecond) waiting.push(pairOf(plant, setting, cut, passage, time, firstS[passage]));
        else firstS[passage] = time;
        continue;
      }
      time = Math.max(time, untilS);
      if (untilS === plant.longest_pass_s) return ended(time, at, true, commands);
      if (untilS === pieceEndsS) {
        drive.next();
        tell(untilS, null);
        continue;
      }
      waiting.splice(waiting.indexOf(pair), 1);
      const pressureKpa = drive.pressureAt(time), isAsked = pair.dueS - 0.5 * pair.trueS >= drive.restsFromS;
      const question = { ...regulator.hear(pair, pair.dueS - heardS, isAsked), s: at.s, pressureKpa };
      heardS = pair.dueS;
      if (question.wanted !== question.before) {
        drive.command(question.wanted, pair.dueS);
        commands += 1;
      }
      tell(pair.dueS, question);
    }
  }

  function pairOf({ sensor }, { noiseS }, { noiseZ }, passage, dueS, firstS) {
    const { sensor: number, axle, column } = sensor.passages[passage], trueS = dueS - firstS;
    const overS = measured(sensor, noiseS, trueS, noiseZ[column]);
    return { passage, sensor: number, axle, dueS, trueS, overS, measured: sensor.base_m / overS };
  }

  return { run, byTable: (plant, table) => new Regulator(plant, table) };
})();
