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

  // Root of the mean square, its interval that of the mean square.
  const rms = (values) => mean(values.map((each) => each * each)).map((each) => Math.sqrt(Math.max(0, each)));

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
      bias: mean(errors),
      overspeed: share(errors.filter((each) => each > overspeedMS).length, n),
      stalled: share(exits.filter(({ stalled }) => stalled).length, n),
      commands: mean(exits.map(({ commands }) => commands)),
      time: mean(exits.map(({ time }) => time)),
    };
  }

  return { of };
})();
