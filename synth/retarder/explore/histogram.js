"use strict";
// Exit errors in bins, the same bins for every regulator that is compared.
const Histogram = (() => {
  const BINS = 24, LEAST_SPREAD_M_S = 0.1;

  const errorsOf = (exits, targetMS) => exits.filter(({ stalled }) => !stalled).map(({ exitMS }) => exitMS - targetMS);

  function counted(errors, spreadMS) {
    const counts = new Array(BINS).fill(0), width = 2 * spreadMS / BINS;
    for (const each of errors) counts[Math.min(BINS - 1, Math.floor((each + spreadMS) / width))] += 1;
    return counts;
  }

  // Cuts in a bin of the histogram that a density expects at the middle of each of its own bins, of so many cuts.
  function expected({ from_m_s: from, width_m_s: width, shares }, cuts, spreadMS) {
    const bin = 2 * spreadMS / BINS, joined = Math.max(1, Math.round(bin / width / 2)), found = [];
    for (let place = 0; place < shares.length; place += joined) {
      const some = shares.slice(place, place + joined), share = some.reduce((sum, each) => sum + each, 0);
      found.push([from + (place + some.length / 2) * width, share / (some.length * width) * bin * cuts]);
    }
    return found;
  }

  // For each list of exits, with the density of its case: { counts, spreadMS, mostCuts, expected }.
  function of(lists, densities, targetMS) {
    const errors = lists.map((exits) => errorsOf(exits, targetMS));
    const spreadMS = 1.05 * Math.max(LEAST_SPREAD_M_S, ...errors.flat().map(Math.abs));
    const found = errors.map((each, place) => ({
      counts: counted(each, spreadMS), spreadMS, expected: expected(densities[place], lists[place].length, spreadMS),
    }));
    const inside = ({ expected: points }) => points.filter(([error]) => Math.abs(error) <= spreadMS).map(([, cuts]) => cuts);
    const mostCuts = Math.max(1, ...found.flatMap((each) => [...each.counts, ...inside(each)]));
    return found.map((each) => ({ ...each, mostCuts }));
  }

  return { of };
})();
