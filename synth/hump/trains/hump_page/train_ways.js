"use strict";
// Where the cuts of a train are at a time, and what its positions do. Pages join this file with those beside it.

const sums = (steps) => { let sum = 0; return Float64Array.from(steps, (step) => (sum += step) / 100); };

const between = (x, xs, ys) => {
  const last = xs.length - 1;
  if (x <= xs[0]) return ys[0];
  if (x >= xs[last]) return ys[last];
  let low = 0, high = last;
  while (high - low > 1) { const middle = (low + high) >> 1; if (xs[middle] <= x) low = middle; else high = middle; }
  return ys[low] + (ys[high] - ys[low]) * (x - xs[low]) / (xs[high] - xs[low]);
};

class TrainWays {
  constructor(train) {
    Object.assign(this, train);
    this.cuts = train.cuts.map((cut, place) => ({ ...cut, place, t: sums(cut.t), s: sums(cut.s), v: sums(cut.v) }));
    this.alarms = train.alarms.map((alarm) => ({ ...alarm, t: alarm.t === null ? train.end_s : alarm.t }));
    const passesOf = (cut) => cut.passes.map(([number, begin, end, entry, command, exit]) =>
      ({ cut, number, begin, end: end === null ? Infinity : end, entry, command, exit }));
    this.passes = this.cuts.flatMap(passesOf).sort((one, other) => one.begin - other.begin);
  }

  // Head, speed and state of every cut. Cuts that are not yet over the crest are pushed, one behind the other.
  places(time) {
    let ahead = null;
    return this.cuts.map((cut) => {
      const last = cut.t.length - 1;
      let head, speed, state;
      if (time >= cut.t[0]) {
        head = between(time, cut.t, cut.s);
        const ends = time >= cut.t[last];
        speed = ends ? 0 : between(time, cut.t, cut.v);
        state = ends ? (cut.coupled_m_s !== null ? "coupled" : "stands") : time < cut.crest_s ? "pushed" : "rolls";
      } else {
        state = "waits";
        speed = 0;
        if (ahead === null) head = 0;
        else if (time <= ahead.cut.crest_s || cut.t[0] <= ahead.cut.crest_s) head = ahead.head - ahead.cut.length_m;
        else head = -0.5 * ahead.cut.length_m * (cut.t[0] - time) / (cut.t[0] - ahead.cut.crest_s);
        head = Math.min(head, 0);
      }
      ahead = { cut, head, speed, state };
      return ahead;
    });
  }

  // What has happened up to a time, in cars and cuts.
  counts(time) {
    const over = this.cuts.filter((cut) => cut.crest_s <= time);
    return {
      cuts: over.length,
      cars: over.reduce((sum, cut) => sum + cut.cars, 0),
      caught: this.cuts.filter((cut) => cut.caught_s !== null && cut.caught_s <= time).length,
      overspeed: this.alarms.filter((alarm) => alarm.kind === "overspeed" && alarm.t <= time).length,
    };
  }

  // Speed at which the train is pushed; null before the first cut is let go, and after the last one.
  humpSpeed(time) {
    const cuts = this.cuts, over = this.counts(time).cuts;
    if (over === 0 || over === cuts.length) return null;
    const [behind, next] = [cuts[over - 1], cuts[over]];
    return between(time, [behind.crest_s, next.crest_s], [behind.hump_speed_m_s, next.hump_speed_m_s]);
  }

  inAlarm(cut, time) { return this.alarms.some((alarm) => alarm.severe && alarm.cut === cut.place && alarm.t <= time); }

  // Numbers of the elements that are occupied.
  held(time) {
    const held = this.occupied.filter(([, , from, to]) => from <= time && (to === null || time < to));
    return new Set(held.map(([number]) => number));
  }
}
