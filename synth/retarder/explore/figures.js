"use strict";
// Figures of some passes, each with the 95 % interval that so many independent passes leave.
const Figures = (() => {
  const NORMAL_95 = 1.959963984540054;

  // Student's 97.5 % quantile by its expansion in 1/n (Abramowitz and Stegun 26.7.5); within 0.001 from 20 passes on.
  function student(freedom) {
    const z = NORMAL_95;
    return z + (z ** 3 + z) / (4 * freedom) + (5 * z ** 5 + 16 * z ** 3 + 3 * z) / (96 * freedom ** 2);
  }

  // Mean with its interval: [value, low, high].
  function mean(values) {
    const n = values.length, average = values.reduce((sum, each) => sum + each, 0) / n;
    const square = values.reduce((sum, each) => sum + (each - average) ** 2, 0) / (n - 1);
    const half = student(n - 1) * Math.sqrt(square / n);
    return [average, average - half, average + half];
  }

  // Root of the mean square of these values. It has no interval: the rarest cuts can make most of it, and few cuts
  // seldom hold one of them.
  const rms = (values) => Math.sqrt(values.reduce((sum, each) => sum + each * each, 0) / values.length);

  // Probability that at most so many of n are among the part `share` of all.
  function atMost(many, n, share) {
    let term = (1 - share) ** n, sum = 0;
    for (let count = 0; count <= many; count++) {
      sum += term;
      term *= (n - count) / (count + 1) * share / (1 - share);
    }
    return sum;
  }

  // A quantile with the interval of order statistics, which holds for every distribution; Infinity: no upper end.
  function quantile(values, part) {
    const sorted = [...values].sort((one, other) => one - other), n = sorted.length, share = 1 - part;
    let most = 0, least = -1;
    while (most < n - 1 && atMost(most, n, share) < 0.975) most += 1;
    while (atMost(least + 1, n, share) <= 0.025) least += 1;
    return [sorted[Math.ceil(n * part) - 1], sorted[n - most - 1], least < 0 ? Infinity : sorted[n - least - 1]];
  }

  // Share of passes, with Wilson's interval.
  function share(count, n) {
    const part = count / n, square = NORMAL_95 ** 2, whole = 1 + square / n;
    const middle = (part + square / (2 * n)) / whole;
    const half = NORMAL_95 / whole * Math.sqrt(part * (1 - part) / n + square / (4 * n * n));
    return [part, Math.max(0, middle - half), Math.min(1, middle + half)];
  }

  function of(exits, targetMS, overspeedMS) {
    const errors = exits.map(({ exitMS }) => exitMS - targetMS), n = exits.length;
    return {
      n,
      rms: rms(errors),
      within: quantile(errors.map(Math.abs), 0.95),
      bias: mean(errors),
      overspeed: share(errors.filter((each) => each > overspeedMS).length, n),
      stalled: share(exits.filter(({ stalled }) => stalled).length, n),
      commands: mean(exits.map(({ commands }) => commands)),
      time: mean(exits.map(({ time }) => time)),
    };
  }

  // Of the same cuts under two regulators, the share that the first lets out nearer to the target; ties are halves.
  function nearer(exits, others, targetMS) {
    const wins = exits.reduce((sum, each, place) => {
      const apart = Math.abs(others[place].exitMS - targetMS) - Math.abs(each.exitMS - targetMS);
      return sum + (apart > 0 ? 1 : apart === 0 ? 0.5 : 0);
    }, 0);
    return share(wins, exits.length);
  }

  return { of, nearer };
})();
