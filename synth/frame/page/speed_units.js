"use strict";
// Units of speed that a page shows, by how many are 1 m/s; the one that was chosen last is remembered.
const SpeedUnits = (() => {
  const FACTORS = { "m/s": 1, "km/h": 3.6, mph: 3600 / 1609.344 };
  const known = (unit) => Object.hasOwn(FACTORS, unit ?? "");

  // A browser may refuse a page from a disk to remember anything.
  function remembered() {
    try {
      const unit = localStorage.getItem("unit");
      return known(unit) ? unit : "m/s";
    } catch { return "m/s"; }
  }

  function remember(unit) {
    try { localStorage.setItem("unit", unit); } catch { return; }
  }

  return { FACTORS, known, remembered, remember };
})();
