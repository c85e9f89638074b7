"use strict";
// What chance gives to a pass. Its numbers follow from the seed and the number of the pass alone, so a slider that moves
// changes nothing else. The generator is sfc32 of PractRand (C. Doty-Humphrey), 32 bits a step.
const Draws = (() => {
  const NOISE_SAMPLES = 256, WARM_UP = 16;

  class Numbers {
    constructor(seed, pass, purpose) {
      this.state = Uint32Array.of(seed, pass, purpose, 1);
      for (let step = 0; step < WARM_UP; step++) this.word();
    }

    word() {
      const [a, b, c, counter] = this.state, found = (a + b + counter) >>> 0;
      this.state[0] = b ^ (b >>> 9);
      this.state[1] = c + (c << 3);
      this.state[2] = ((c << 21) | (c >>> 11)) + found;
      this.state[3] = counter + 1;
      return found;
    }

    // Uniform, above 0 and below 1.
    uniform() { return (this.word() + 0.5) / 2 ** 32; }

    // Standard normal (Box and Muller).
    normal() { return Math.sqrt(-2 * Math.log(this.uniform())) * Math.cos(2 * Math.PI * this.uniform()); }

    // Gamma with this shape, 1 or more, and scale 1 (Marsaglia and Tsang 2000); below 1 by a power of a uniform number.
    gamma(shape) {
      if (shape < 1) return this.gamma(shape + 1) * this.uniform() ** (1 / shape);
      const d = shape - 1 / 3, c = 1 / Math.sqrt(9 * d);
      for (;;) {
        const x = this.normal(), v = (1 + c * x) ** 3;
        if (v > 0 && Math.log(this.uniform()) < 0.5 * x * x + d - d * v + d * Math.log(v)) return d * v;
      }
    }
  }

  // Each purpose has numbers of its own: a path with more cells does not move the noise.
  const CUT = 0, PATH = 1, NOISE = 2, LOSS = 3;

  function normals(seed, pass, purpose, count) {
    const numbers = new Numbers(seed, pass, purpose);
    return Float32Array.from({ length: count }, () => numbers.normal());
  }

  // Numbers of the radar, NaN where a reading is lost: bursts, a Markov chain of two states.
  function noise(sensor, seed, pass) {
    const z = normals(seed, pass, NOISE, NOISE_SAMPLES);
    if (sensor.missed_share === 0) return z;
    const numbers = new Numbers(seed, pass, LOSS), ends = 1 / sensor.missed_readings;
    const begins = ends * sensor.missed_share / (1 - sensor.missed_share);
    let lost = numbers.uniform() < sensor.missed_share;
    return z.map((value) => {
      lost = numbers.uniform() < (lost ? 1 - ends : begins);
      return lost ? NaN : value;
    });
  }

  function quantile(values, u) {
    const place = u * (values.length - 1), low = Math.min(Math.trunc(place), values.length - 2);
    return values[low] + (place - low) * (values[low + 1] - values[low]);
  }

  // A cut as they come: everything is drawn.
  function cut(plant, seed, pass) {
    const { laws, sensor } = plant, numbers = new Numbers(seed, pass, CUT), mean = laws.resistance_mean;
    const shape = (mean / laws.resistance_std) ** 2;
    return {
      factor: Math.max(laws.factor_floor, 1 + laws.factor_cv * numbers.normal()),
      entryMS: quantile(laws.entry, numbers.uniform()),
      phase: numbers.uniform(),
      resistance: laws.resistance_std === 0 ? mean : numbers.gamma(shape) * mean / shape,
      pathZ: normals(seed, pass, PATH, plant.edges_m.length - 1),
      noiseZ: noise(sensor, seed, pass),
    };
  }

  return { cut };
})();
