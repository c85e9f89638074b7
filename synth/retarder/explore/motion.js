"use strict";
// The motion of a cut (plant_models.motion): within a path cell and at a constant pressure its acceleration is constant.
// A cell has been worked out in Python: grade, braking force for each kPa, and how much the friction varies along it.
const Motion = (() => {
  const MOVES = 0, LEFT = 1, STANDS = 2, THERE = 3;

  // The cut in numbers: its inertia is mass and rotating wheels; its mass lies between the limits of its class.
  function cut(plant, massT) {
    const inertiaT = massT + plant.rotating_t;
    return { inertiaT, gravity: plant.gravity_m_s2 * massT / inertiaT * 1e-3 };
  }

  // Force of the brake for each kPa in a cell, kN: constant in the mass or proportional to it, so a line is exact.
  function force(plant, massT, cell) {
    const [low, high] = plant.mass_limits_t, [light, heavy] = plant.force_kn_per_kpa;
    if (high === low) return light[cell];
    return light[cell] + (heavy[cell] - light[cell]) * (massT - low) / (high - low);
  }

  // Acceleration without brake and deceleration by one kPa, m/s2, in every cell.
  function cells(plant, massT, { factor, resistance, pathZ }) {
    const { inertiaT, gravity } = cut(plant, massT), count = plant.grade_permille.length;
    const free = new Float64Array(count), brake = new Float64Array(count);
    let eta = 0;
    for (let cell = 0; cell < count; cell++) {
      free[cell] = gravity * plant.grade_permille[cell] - gravity * resistance;
      if (cell < plant.approach_cells) continue;
      eta = plant.eta_memory[cell] * eta + plant.eta_fresh[cell] * pathZ[cell - plant.approach_cells];
      const along = factor * Math.max(0, 1 + plant.eta_std[cell] * eta);
      brake[cell] = force(plant, massT, cell) / inertiaT * along;
    }
    return { edges: plant.edges_m, free, brake };
  }

  // Speed where the pass begins of a cut that comes to the entrance with this speed: nothing brakes before it.
  function startSpeed(plant, path, entryMS) {
    if (plant.approach_cells === 0) return entryMS;
    let gained = 0;
    for (let cell = 0; cell < plant.approach_cells; cell++) {
      gained += path.free[cell] * (path.edges[cell + 1] - path.edges[cell]);
    }
    return Math.sqrt(Math.max(entryMS * entryMS - 2 * gained, plant.slowest_start_m_s * plant.slowest_start_m_s));
  }

  // Moves `at` (cell, s, v) for `duration` seconds under an overpressure, but no farther than `toM`; returns how that
  // ends and the time used.
  function advance(path, at, kpa, duration, toM = Infinity) {
    let left = duration;
    for (;;) {
      const a = path.free[at.cell] - path.brake[at.cell] * kpa, edge = path.edges[at.cell + 1];
      const goal = Math.min(edge, toM), gap = Math.max(0, goal - at.s);
      const end = at.v + a * left, way = 0.5 * (at.v + end) * left;
      if (end > 0 && way < gap) {
        at.s += way;
        at.v = end;
        return [MOVES, duration];
      }
      const square = at.v * at.v + 2 * a * gap;
      if (square <= 0) {
        const used = duration - left - at.v / a;
        at.s -= 0.5 * at.v * at.v / a;
        at.v = 0;
        return [STANDS, used];
      }
      const speed = Math.sqrt(square);
      left = Math.max(0, left - 2 * gap / (at.v + speed));
      at.v = speed;
      at.s = Math.max(at.s, goal);
      if (edge <= toM) {
        at.cell += 1;
        if (at.cell === path.free.length) return [LEFT, duration - left];
      }
      if (toM <= edge) return [THERE, duration - left];
    }
  }

  return { MOVES, LEFT, STANDS, THERE, cells, startSpeed, advance };
})();
