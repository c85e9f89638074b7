"""A retarder position by other laws than those of `plant_models`: values only, nothing moves here.

It is the unknown railway of the tests of identification. Where it differs from our plant:

              ours                                    here
filling       first order, P -> supply pressure       isentropic flow through an orifice, choked and not, out of a
                                                      supply line of finite volume that sinks meanwhile
exhausting    first order, P -> 0                     the same flow through another orifice
valves        dead times; open and shut at once       a delay with jitter; they open and shut in finite time, so a
                                                      stage rests inside its dead band, not at the edge
touch         force 0, then linear in P - P0; an      a soft dead zone: 0, a parabola, then the line; constant volume,
              extra dead time below P0                so no dead time
friction      the same at every speed                 falls with speed, mu0 (1 + c / (v + d))
              normal over cuts; Markov along the      lognormal over cuts; a sum of cosines along the path, felt by
              path of the first axle                  each axle at its own place
zones         an axle is braked or not                beams have flares: the clamp force rises and falls smoothly
resistance    gamma over cuts, the same at any speed  lognormal over cuts, a + b v^2
grade         constant over stretches                 linear between knots
gauge         the pressure of the drive               behind a pipe: it lags, and it is noisy
path          exact                                   measured with an error
entry         uniform, at the entrance                normal between two limits, 4 m ahead of the entrance

Masses in t, forces in kN, pressures in kPa (gauge, if not called absolute), lengths in m, volumes in litres, areas in
mm2, times in s.
"""

from __future__ import annotations

from dataclasses import dataclass

GRAVITY_M_S2 = 9.81
ROTATING_T_PER_AXLE = 0.42
GAS_CONSTANT_J_KG_K = 287.0

SHORTEST_LAG_S = 0.004
"""Of a gauge; with less the integration would need a shorter step."""


@dataclass(frozen=True)
class ForeignTrack:
    """Where the beams stand and how the track falls.

    `zones_m`: begin and end of each retarder, the first begins at 0. `grades_permille` at `knots_m`, linear between,
    constant outside; every axle feels the grade at its own place. `seen_from_m`: path of the first axle, at most 0, at
    which the radar first sees a cut.
    """

    zones_m: tuple[tuple[float, float], ...]
    knots_m: tuple[float, ...]
    grades_permille: tuple[float, ...]
    seen_from_m: float = -4.0

    def __post_init__(self) -> None:
        _require(self.seen_from_m <= 0.0, "track: seen_from_m is behind the entrance")
        _require(len(self.knots_m) == len(self.grades_permille) >= 1, "track: as many knots as grades, at least one")


@dataclass(frozen=True)
class ForeignCut:
    """A cut, and the lognormal law of its rolling resistance rho (a + b v^2), mean of rho 1, in N/kN."""

    category: str
    mass_t: float
    axle_offsets_m: tuple[float, ...]
    resistance_n_per_kn: float
    resistance_n_per_kn_per_m2_s2: float
    resistance_cv: float

    @property
    def inertia_t(self) -> float:
        """Mass and rotating mass."""
        return self.mass_t + ROTATING_T_PER_AXLE * len(self.axle_offsets_m)


@dataclass(frozen=True)
class ForeignBrake:
    """Force of the beams on one braked axle: clamp(p) xi (1 + eta(s)) mu(v), with mu(v) = mu0 (1 + c / (v + d)).

    clamp(p) = `clamp_kn_per_kpa` (p - `touch_kpa`) beyond `touch_kpa` + `softness_kpa`, 0 below `touch_kpa` -
    `softness_kpa`, a parabola between. xi is lognormal over cuts, of mean 1 and `cut_cv`. eta is a sum of `waves`
    cosines of equal amplitude, of variance `path_std`^2, their lengths log-uniform within `wave_lengths_m`. The force
    rises over the first `flare_m` of a beam, and falls over the last.
    """

    clamp_kn_per_kpa: float
    touch_kpa: float
    softness_kpa: float
    friction: float
    friction_rise_m_s: float
    friction_speed_m_s: float
    cut_cv: float
    path_std: float
    wave_lengths_m: tuple[float, float] = (1.5, 12.0)
    waves: int = 8
    flare_m: float = 0.6

    def __post_init__(self) -> None:
        _require(self.flare_m > 0.0, "brake: flare_m must be above 0")
        _require(0.0 < self.softness_kpa <= self.touch_kpa, "brake: softness_kpa must be above 0, up to touch_kpa")
        most = (0.5 / self.waves) ** 0.5
        _require(self.path_std <= most, f"brake: path_std must be at most {most:.3g}, else beams would push")

    def friction_at(self, speed_m_s: float) -> float:
        """mu(v)."""
        return self.friction * (1.0 + self.friction_rise_m_s / (speed_m_s + self.friction_speed_m_s))

    def mean_slope_kn_per_kpa(self, speed_m_s: float) -> float:
        """Mean friction force on one axle by one kPa of overpressure: what our plant calls the slope of the force."""
        return self.clamp_kn_per_kpa * self.friction_at(speed_m_s)


@dataclass(frozen=True)
class ForeignDrive:
    """Main reservoir - orifice - supply line - fill valve - cylinder - exhaust valve - atmosphere.

    `exponent`: of the gas in cylinder and line, 1 isothermal to 1.4 adiabatic, at constant `temperature_k` of what
    flows. A valve begins to open its delay after the regulator asked for it, plus or minus up to `delay_jitter_s`
    (uniform), is open `opening_s` later, and shuts within `closing_s`. The regulator shuts a valve when the pressure
    in the cylinder comes within `band_kpa` of the stage.
    """

    main_kpa: float = 700.0
    line_litres: float = 40.0
    line_orifice_mm2: float = 60.0
    cylinder_litres: float = 12.0
    fill_orifice_mm2: float = 105.0
    exhaust_orifice_mm2: float = 160.0
    discharge: float = 0.75
    exponent: float = 1.0
    temperature_k: float = 283.0
    atmosphere_kpa: float = 101.3
    fill_delay_s: float = 0.14
    exhaust_delay_s: float = 0.09
    delay_jitter_s: float = 0.015
    opening_s: float = 0.06
    closing_s: float = 0.015
    band_kpa: float = 15.0
    gauge_lag_s: float = 0.04

    def __post_init__(self) -> None:
        for name in ("fill_delay_s", "exhaust_delay_s"):
            _require(getattr(self, name) >= self.delay_jitter_s >= 0.0, f"drive: {name} must be above delay_jitter_s")
        for name in ("opening_s", "closing_s"):
            _require(getattr(self, name) > 0.0, f"drive: {name} must be above 0")
        _require(self.gauge_lag_s >= SHORTEST_LAG_S, f"drive: gauge_lag_s must be at least {SHORTEST_LAG_S:g}")

    def rate_per_s(self, orifice_mm2: float, volume_litres: float) -> float:
        """dp/dt = rate psi p_up for a flow through this orifice into or out of this volume; psi: `flow_kpa`."""
        speed = (GAS_CONSTANT_J_KG_K * self.temperature_k) ** 0.5
        return float(self.exponent * self.discharge * orifice_mm2 * 1e-6 * speed / (volume_litres * 1e-3))


@dataclass(frozen=True)
class ForeignSensor:
    """Radar (`noise_m_s`, then rounded to `resolution_m_s`), path, gauge (NaN in the log if there is none), clock."""

    period_s: float = 0.1
    computing_delay_s: float = 0.02
    noise_m_s: float = 0.06
    resolution_m_s: float = 0.04
    path_noise_m: float = 0.0
    has_gauge: bool = True
    gauge_noise_kpa: float = 2.0

    def __post_init__(self) -> None:
        _require(0.0 <= self.computing_delay_s < self.period_s, "sensor: computing_delay_s must be below period_s")


@dataclass(frozen=True)
class ForeignEntry:
    """Speed where the radar first sees the cut: normal, only what lies between the limits, m/s."""

    mean_m_s: float = 5.7
    std_m_s: float = 0.4
    low_m_s: float = 5.0
    high_m_s: float = 6.5

    def __post_init__(self) -> None:
        _require(0.0 < self.low_m_s < self.high_m_s, "entry: low_m_s must be above 0 and below high_m_s")


@dataclass(frozen=True)
class ForeignPlant:
    """A cut of one class at a position; `stage_pressures_kpa` are those that the regulator is set to."""

    track: ForeignTrack
    cut: ForeignCut
    brake: ForeignBrake
    drive: ForeignDrive
    sensor: ForeignSensor
    entry: ForeignEntry
    stage_pressures_kpa: tuple[float, ...]

    @property
    def exit_m(self) -> float:
        """Path of the first axle at which the last one leaves the last retarder."""
        return self.track.zones_m[-1][1] + self.cut.axle_offsets_m[-1]


def neighbour_of_knp5(mass_t: float, category: str, axle_offsets_m: tuple[float, ...]) -> ForeignPlant:
    """A plausible neighbour of the library's position knp-5-bunch: same place and stages, other laws.

    At 4 m/s an axle is braked by 0.030 kN/kPa in the mean, 17 % less than the library assumes; 300 kPa are reached
    about 0.5 s after a command from 0.
    """
    return ForeignPlant(
        track=ForeignTrack(((0.0, 12.475), (14.475, 26.95)), (-5.0, 10.0, 40.0), (8.6, 8.4, 7.2)),
        cut=ForeignCut(category, mass_t, axle_offsets_m, 0.95 + 12.0 / mass_t, 0.012 + 0.5 / mass_t, 0.35),
        brake=ForeignBrake(0.2136, 55.0, 20.0, 0.09, 4.0, 3.0, 0.18, 0.12),
        drive=ForeignDrive(),
        sensor=ForeignSensor(),
        entry=ForeignEntry(),
        stage_pressures_kpa=(0.0, 150.0, 300.0, 450.0, 600.0),
    )


def _require(holds: bool, sentence: str) -> None:
    if not holds:
        raise ValueError(sentence + ".")
