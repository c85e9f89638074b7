"use strict";
// The sliders: each declared once, with its range and what the configuration says; and the state as the link has it.
const Controls = (() => {
  const M_S = true, LOWEST_ENTRY_M_S = 0.5, MOST_SEED = 9999;

  const isRadar = ({ sensor }) => sensor.passages === undefined;

  // `range` and `usual` of a class; `isSpeed`: shown in the unit of speeds; `of`: the group, this cut or the plant;
  // `has`: whether a plant has it, every one unless said.
  const SLIDERS = [
    { key: "entry", label: "entry speed", of: "cut", isSpeed: M_S, step: 0.01, digits: 2,
      range: ({ laws, max_entry_m_s: most }) => [Math.max(LOWEST_ENTRY_M_S, laws.entry[0] - 1), most],
      usual: ({ laws }) => laws.entry[Math.trunc(laws.entry.length / 2)] },
    { key: "factor", label: "pad friction, × mean", of: "cut", step: 0.01, digits: 2,
      range: ({ laws }) => [Math.max(laws.factor_floor, 0.4), 1.6], usual: () => 1 },
    { key: "resistance", label: "rolling resistance, N/kN", of: "cut", step: 0.01, digits: 2,
      range: ({ laws }) => [0, Math.max(2 * laws.resistance_mean, laws.resistance_mean + 5 * laws.resistance_std)],
      usual: ({ laws }) => laws.resistance_mean },
    { key: "seed", label: "seed of chance", of: "cut", step: 1, digits: 0, range: () => [1, MOST_SEED], usual: () => 1 },
    { key: "mass", label: "mass of the cut, t", of: "plant", step: 0.1, digits: 1,
      range: ({ mass_limits_t: limits }) => limits, usual: ({ mass_t: mass }) => mass },
    { key: "noise", label: "radar noise", of: "plant", isSpeed: M_S, step: 0.001, digits: 3, has: isRadar,
      range: ({ sensor }) => [0, Math.max(0.3, 4 * sensor.noise_m_s)], usual: ({ sensor }) => sensor.noise_m_s },
    { key: "timer", label: "noise of the timer, ms", of: "plant", step: 0.01, digits: 2, has: (plant) => !isRadar(plant),
      range: ({ sensor }) => [0, Math.max(1, 4e3 * sensor.timer_noise_s)], usual: ({ sensor }) => 1e3 * sensor.timer_noise_s },
    { key: "delay", label: "valve delays, × configured", of: "plant", step: 0.05, digits: 2,
      range: () => [0, 4], usual: () => 1 },
  ];

  const slidersOf = (plant) => SLIDERS.filter(({ has }) => has === undefined || has(plant));
  const within = (value, [low, high]) => Math.min(Math.max(value, low), high);
  const usual = (plant) => Object.fromEntries(slidersOf(plant).map(({ key, usual: of }) => [key, of(plant)]));

  // Whether mass, noise and delays are those of the configuration, to what a slider can be set to.
  const isConfigured = (plant, values) =>
    slidersOf(plant).every(({ key, of, step, usual: as }) => of !== "plant" || Math.abs(values[key] - as(plant)) < step / 2);

  // What the link says: words by key. Numbers that are none, and keys that are unknown, are passed over.
  const asked = () => new URLSearchParams(location.hash.slice(1));

  function valuesAsked(plant, words) {
    const found = usual(plant);
    for (const { key, range } of slidersOf(plant)) {
      const number = words.has(key) ? Number(words.get(key)) : NaN;
      if (Number.isFinite(number) && words.get(key).trim() !== "") found[key] = within(number, range(plant));
    }
    found.seed = Math.round(found.seed);
    return found;
  }

  // Of the sliders only what differs from the configuration stands in the link.
  function link(plant, table, values, others) {
    const words = new URLSearchParams({ table });
    for (const { key, usual: as, step, digits } of slidersOf(plant)) {
      if (Math.abs(values[key] - as(plant)) >= step / 2) words.set(key, values[key].toFixed(Math.max(digits, 3)));
    }
    for (const [key, value] of Object.entries(others)) words.set(key, value);
    return `#${words}`;
  }

  return { SLIDERS, MOST_SEED, isRadar, slidersOf, usual, isConfigured, asked, valuesAsked, link };
})();
