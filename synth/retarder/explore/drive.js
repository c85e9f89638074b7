"use strict";
// The pneumatic drive (plant_models.pneumatics, valve_drive, stage_regulator): supply or exhaust opens after its delay,
// the pressure goes on as an exponential, and the valve shuts at the edge of the dead band.
const Drive = (() => {
  const MOST_OPENINGS = 40, EDGE = 1 + 1e-12, SAME_KPA = 1e-9;

  // The delays of the valves, so many times those of the configuration.
  function slower(valves, times) {
    const found = { ...valves };
    for (const name of ["brake_delay_s", "touch_delay_s", "release_delay_s"]) found[name] = valves[name] * times;
    return found;
  }

  const delayOf = (valves, kpa, rises) =>
    rises ? valves.brake_delay_s + (kpa <= valves.touch_kpa ? valves.touch_delay_s : 0) : valves.release_delay_s;

  // The pressure after a command at rest: pieces [start, pressure, asymptote, time constant]; the last one stays.
  function respond(valves, startKpa, targetKpa) {
    const pieces = [];
    let time = 0, kpa = startKpa;
    for (let opening = 0; opening < MOST_OPENINGS; opening++) {
      pieces.push([time, kpa, kpa, 1]);
      const error = targetKpa - kpa;
      if (Math.abs(error) <= valves.band_kpa * EDGE) return pieces;
      const rises = error > 0;
      const asymptote = rises ? valves.supply_kpa : valves.exhaust_kpa;
      const constant = rises ? valves.fill_s : valves.exhaust_s;
      const edge = targetKpa + (rises ? -valves.band_kpa : valves.band_kpa);
      const delay = delayOf(valves, kpa, rises);
      pieces.push([time + delay, kpa, asymptote, constant]);
      const open = constant * Math.log((asymptote - kpa) / (asymptote - edge)) + valves.closing_delay_s;
      time += delay + open;
      kpa = valves.closing_delay_s === 0 ? edge : asymptote + (kpa - asymptote) * Math.exp(-open / constant);
    }
    return null;
  }

  // Integral over x seconds of what an exponential from b to a is above 0.
  function above(x, b, a, constant) {
    const whole = (time) => a * time - (b - a) * constant * Math.expm1(-time / constant);
    if (b >= 0 && a >= 0) return whole(x);
    if (b <= 0 && a <= 0) return 0;
    const crossing = constant * Math.log((a - b) / a);
    return b > 0 ? whole(Math.min(x, crossing)) : whole(Math.max(x, crossing)) - whole(crossing);
  }

  // Integral of the overpressure from the command until `time`, kPa s.
  function overpressure(pieces, time, touchKpa) {
    let total = 0;
    pieces.forEach(([start, kpa, asymptote, constant], place) => {
      const end = place + 1 < pieces.length ? pieces[place + 1][0] : Infinity;
      total += above(Math.max(Math.min(time, end) - start, 0), kpa - touchKpa, asymptote - touchKpa, constant);
    });
    return total;
  }

  function pressureAt(pieces, time) {
    let place = 0;
    while (place + 1 < pieces.length && pieces[place + 1][0] <= time) place += 1;
    const [start, kpa, asymptote, constant] = pieces[place];
    return asymptote + (kpa - asymptote) * Math.exp(-(time - start) / constant);
  }

  // Parts of a sampling period, those that follow alike joined: [{ kpa, seconds }].
  function joined(parts, part, alike) {
    const found = [];
    let first = 0;
    for (let place = 1; place <= parts.length; place++) {
      if (place < parts.length && alike(parts[place], parts[place - 1], parts[first])) continue;
      found.push({ kpa: parts[first], seconds: (place - first) * part });
      first = place;
    }
    return found;
  }

  const mean = (parts) => parts.reduce((sum, each) => sum + each, 0) / parts.length;
  const restOf = (valves, kpa) => Math.max(0, kpa - valves.touch_kpa);

  // Where the regulator can rest: of each stage the pressure from below, then that from above.
  function restingModes(valves, stageKpa) {
    const top = stageKpa.length - 1, modes = [];
    const reached = (from, to) => respond(valves, stageKpa[from], stageKpa[to]).at(-1)[1];
    for (let stage = 0; stage <= top; stage++) {
      if (stage > 0) modes.push({ stage, kpa: reached(stage - 1, stage) });
      if (stage < top) modes.push({ stage, kpa: reached(stage + 1, stage) });
    }
    return modes;
  }

  // Commands only at rest: what the drive plays after a command is known when it is given.
  class AtRest {
    constructor(valves, plant) {
      Object.assign(this, { valves, plant, chains: new Map() });
      this.modes = restingModes(valves, plant.stage_kpa);
    }

    begin() {
      this.mode = this.modes.findIndex(({ stage }) => stage === this.plant.initial_stage);
      this.chain = null;
      this.overpressureKpa = restOf(this.valves, this.modes[this.mode].kpa);
    }

    get isAsked() { return this.chain === null; }
    get pressureKpa() {
      if (this.chain === null) return this.modes[this.mode].kpa;
      const since = this.played * this.plant.sensor.period_s - this.plant.sensor.computing_delay_s;
      return since < 0 ? this.chain.pieces[0][1] : pressureAt(this.chain.pieces, since);
    }

    // Plays the period that begins now; `wanted`: the stage in force from now on.
    play(wanted) {
      if (this.chain === null && wanted !== this.modes[this.mode].stage) {
        this.chain = this.chainTo(wanted);
        this.played = 0;
      }
      if (this.chain === null) {
        const kpa = restOf(this.valves, this.modes[this.mode].kpa);
        return { pieces: [{ kpa, seconds: this.plant.sensor.period_s }], meanKpa: kpa };
      }
      const period = this.chain.periods[this.played];
      this.played += 1;
      if (this.played === this.chain.periods.length) {
        this.mode = this.chain.mode;
        this.chain = null;
      }
      return period;
    }

    chainTo(wanted) {
      const key = `${this.mode} ${wanted}`;
      if (!this.chains.has(key)) this.chains.set(key, this.newChain(wanted));
      return this.chains.get(key);
    }

    newChain(wanted) {
      const { valves, plant } = this, from = this.modes[this.mode].kpa, { sensor } = plant;
      const pieces = respond(valves, from, plant.stage_kpa[wanted]), end = pieces.at(-1);
      const busy = sensor.computing_delay_s + end[0], part = sensor.period_s / plant.substeps;
      const periods = Math.max(1, Math.ceil(busy / sensor.period_s - 1e-9));
      const until = (edge) => restOf(valves, from) * Math.min(edge, 0) +
        overpressure(pieces, Math.max(edge, 0), valves.touch_kpa);
      const parts = Array.from({ length: periods * plant.substeps }, (_, place) => {
        const edge = place * part - sensor.computing_delay_s, next = (place + 1) * part - sensor.computing_delay_s;
        return rint((until(next) - until(edge)) / (next - edge) * 1e9) / 1e9;
      });
      const played = (some) => joined(some, part, (one, before) => one === before);
      const found = Array.from({ length: periods }, (_, period) => {
        const some = parts.slice(period * plant.substeps, (period + 1) * plant.substeps);
        return { pieces: played(some), meanKpa: mean(some) };
      });
      return { pieces, periods: found, whole: played(parts), mode: this.nearestMode(wanted, end[1]) };
    }

    nearestMode(stage, kpa) {
      const far = this.modes.map((mode) => mode.stage === stage ? Math.abs(mode.kpa - kpa) : Infinity);
      return far.indexOf(Math.min(...far));
    }
  }

  // Commands at rest too, but at any time: what is played after a command goes on by itself, piece by piece.
  class AtPulses extends AtRest {
    begin() {
      super.begin();
      Object.assign(this, { begunS: 0, restsFromS: -Infinity });
    }

    get pieceKpa() { return this.chain === null ? restOf(this.valves, this.modes[this.mode].kpa) : this.chain.whole[this.place].kpa; }
    get pieceEndsS() { return this.chain === null ? Infinity : this.endS; }

    pressureAt(timeS) {
      if (this.chain === null) return this.modes[this.mode].kpa;
      const since = timeS - this.begunS - this.plant.sensor.computing_delay_s;
      return since < 0 ? this.chain.pieces[0][1] : pressureAt(this.chain.pieces, since);
    }

    command(wanted, timeS) {
      const chain = this.chainTo(wanted);
      Object.assign(this, { chain, place: 0, begunS: timeS, restsFromS: Infinity });
      this.endS = timeS + chain.whole[0].seconds;
    }

    // The piece that plays has ended.
    next() {
      this.place += 1;
      if (this.place < this.chain.whole.length) {
        this.endS += this.chain.whole[this.place].seconds;
        return;
      }
      Object.assign(this, { mode: this.chain.mode, chain: null, restsFromS: this.endS });
    }
  }

  // Commands at every sample: the pressure, and how long a valve still waits, are carried on.
  class AtAnyTime {
    constructor(valves, plant) {
      Object.assign(this, { valves, plant });
      this.restKpa = restingModes(valves, plant.stage_kpa).find(({ stage }) => stage === plant.initial_stage).kpa;
    }

    begin() {
      Object.assign(this, { pressureKpa: this.restKpa, wait: 0, stage: this.plant.initial_stage });
      this.overpressureKpa = restOf(this.valves, this.restKpa);
    }

    get isAsked() { return true; }

    play(wanted) {
      const { plant, valves } = this, { period_s: period, computing_delay_s: delay } = plant.sensor;
      const part = period / plant.substeps, parts = [];
      const [old, next] = [this.stage, wanted].map((stage) => plant.stage_kpa[stage]);
      let commanded = false;
      for (let place = 0; place < plant.substeps; place++) {
        let total = 0;
        if (commanded) {
          total = this.driveOn(next, part);
        } else if (delay >= place * part + part * (1 - 1e-9)) {
          total = this.driveOn(old, part);
        } else {
          const before = Math.max(delay - place * part, 0);
          total = this.driveOn(old, before);
          this.wait = waitAfter(valves, this.pressureKpa, this.wait, old, next);
          total += this.driveOn(next, part - before);
          commanded = true;
        }
        parts.push(total / part);
      }
      this.stage = wanted;
      return { pieces: joined(parts, part, (one, _, first) => Math.abs(one - first) < SAME_KPA), meanKpa: mean(parts) };
    }

    // Moves the pressure on with a stage commanded; returns the integral of the overpressure.
    driveOn(stageKpa, seconds) {
      const { valves } = this, kpa = this.pressureKpa, error = stageKpa - kpa, rises = error > 0;
      const standing = restOf(valves, kpa) * seconds;
      if (Math.abs(error) <= valves.band_kpa * EDGE) {
        this.wait = 0;
        return standing;
      }
      if (this.wait >= seconds) {
        this.wait -= seconds;
        return standing;
      }
      const asymptote = rises ? valves.supply_kpa : valves.exhaust_kpa;
      const constant = rises ? valves.fill_s : valves.exhaust_s;
      const until = stageKpa + (rises ? -valves.band_kpa : valves.band_kpa), waited = this.wait;
      let flowing = seconds - waited, end = asymptote + (kpa - asymptote) * Math.exp(-flowing / constant);
      const rests = rises ? end >= until : end <= until;
      if (rests) {
        flowing = Math.min(constant * Math.log((asymptote - kpa) / (asymptote - until)), flowing);
        end = until;
      }
      this.pressureKpa = end;
      this.wait = 0;
      const over = restOf(valves, kpa) * waited +
        above(flowing, kpa - valves.touch_kpa, asymptote - valves.touch_kpa, constant);
      return rests ? over + restOf(valves, end) * (seconds - waited - flowing) : over;
    }
  }

  // A valve that is open, or about to open, goes on for a command of the same direction; else the whole delay.
  function waitAfter(valves, kpa, wait, oldKpa, newKpa) {
    const band = valves.band_kpa * EDGE, before = oldKpa - kpa, now = newKpa - kpa;
    if (Math.abs(now) <= band) return 0;
    if (Math.abs(before) > band && before > 0 === now > 0) return wait;
    return delayOf(valves, kpa, now > 0);
  }

  // To the nearest whole number, halves to the even one.
  function rint(value) {
    const low = Math.floor(value), part = value - low;
    if (part !== 0.5) return Math.round(value);
    return low % 2 === 0 ? low : low + 1;
  }

  function drive(plant, atAnyTime, delayTimes) {
    const kind = plant.sensor.passages ? AtPulses : atAnyTime ? AtAnyTime : AtRest;
    return new kind(slower(plant.valves, delayTimes), plant);
  }

  return { drive, rint };
})();
