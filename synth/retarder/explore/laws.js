"use strict";
// The regulators of a cut that a radar sees: each is asked at every sample, and knows the stage that it commanded last.
const Laws = (() => {
  // The stage that the position lets a regulator command.
  const admitted = (plant, stage, wanted, s) => s < 0 ? Math.min(wanted, Math.max(stage, plant.entrance_stage)) : wanted;

  class Regulator {
    constructor(plant) { this.plant = plant; }

    begin() { Object.assign(this, { stage: this.plant.initial_stage, passedKpa: 0 }); }

    // Everything about the question at a sample, for the words; `isAsked` false: a change of stage is under way.
    ask(s, measured, pressureKpa, isAsked) {
      const { stage, plant } = this, known = this.speedAt(s, measured);
      const told = { s, measured, known, pressureKpa, isAsked, before: stage, wanted: stage, alarms: this.alarms() };
      if (isAsked) told.wanted = admitted(plant, stage, this.decide(stage, s, known, pressureKpa), s);
      this.stage = told.wanted;
      return told;
    }

    alarms() { return 0; }
  }

  // The rule of a table, with its estimator if it has one.
  class ByTable extends Regulator {
    constructor(plant, table) {
      super(plant);
      Object.assign(this, { table, atAnyTime: table.at_any_time === 1 });
    }

    begin() {
      super.begin();
      this.estimate = Rule.estimate();
    }

    speedAt(s, measured) {
      return this.table.breaks > 0 ? Rule.observe(this.table, this.estimate, s, measured, this.passedKpa) : measured;
    }

    decide(stage, s, known, pressureKpa) { return Rule.decide(this.table, stage, s, known, pressureKpa); }
    alarms() { return this.table.breaks > 0 ? Rule.alarms(this.table, this.estimate) : 0; }
  }

  // Switching lines as a baseline has them (synth.kernels.loop.regulator), compared with the measured speed and, with a
  // lead, what it will be; `lines`: speeds at nodes, null where a stage has no line.
  class ByLines extends Regulator {
    constructor(plant, lines) {
      super(plant);
      Object.assign(this, { lines, atAnyTime: lines.at_any_time === 1 });
    }

    begin() {
      super.begin();
      Object.assign(this, { slope: 0, last: NaN });
    }

    speedAt(_, measured) {
      const { lead_s: lead, filter_s: filter } = this.lines, { period_s: period } = this.plant.sensor;
      if (lead === 0) return measured;
      const change = measured - this.last;
      if (!Number.isNaN(change)) this.slope += period / (period + filter) * (change / period - this.slope);
      this.last = measured;
      return measured + lead * this.slope;
    }

    answer(stage, s, v) {
      const { lower, upper, start_m: start, spacing_m: spacing } = this.lines, place = (s - start) / spacing;
      const at = (row) => {
        const node = Math.min(Math.trunc(place), row.length - 2);
        return row[node] + (place - node) * (row[node + 1] - row[node]);
      };
      if (lower[stage] !== null && v < at(lower[stage])) return -1;
      return upper[stage] !== null && v > at(upper[stage]) ? 1 : 0;
    }

    decide(stage, s, v) {
      const { lower, farthest } = this.lines, top = lower.length - 1, step = this.answer(stage, s, v);
      let wanted = Math.min(Math.max(stage + step, 0), top);
      while (step !== 0 && wanted > 0 && wanted < top && Math.abs(wanted - stage) < farthest) {
        if (this.answer(wanted, s, v) !== step) break;
        wanted += step;
      }
      return wanted;
    }
  }

  return { byTable: (plant, table) => new ByTable(plant, table), byLines: (plant, lines) => new ByLines(plant, lines) };
})();
