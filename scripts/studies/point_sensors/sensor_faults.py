"""Faults of point sensors: each turns the pulse pairs of passes into those that the regulator hears.

A fault is a value. It acts on what the faults before it have left, and on sensors by the number under which they are
heard. What chance decides follows from the numbers of the pass alone, so a pass meets the same fault under every
controller. Two faults of chance in one list get different numbers by their `stream`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from plant_models import PointSensors
from plant_models.frozen_arrays import Bools, Floats
from plant_models.rolling.random_numbers import Purpose, keyed_uniform
from synth.kernels.loop.passage_loop import WATCHED_FROM_S
from synth.kernels.loop.passes import Draws
from synth.simulation.passage_controller import BY_THE_CLOCK, HeardPairs
from synth.simulation.passage_loop import Faults

KEY_COLUMNS = (222, 223)
"""Columns of `noise_z` that tell passes apart; only a pass with more than 222 passages reads them for its timer."""


@dataclass(frozen=True)
class Scene:
    """Where faults happen: the sensors, and the passes that were drawn."""

    sensors: PointSensors
    draws: Draws

    def uniform(self, stream: int, columns: int) -> Floats:
        """Uniform numbers of each pass, (n, `columns`)."""
        words = np.ascontiguousarray(self.draws.noise_z[:, KEY_COLUMNS]).view(np.uint32).astype(np.int64)
        return keyed_uniform(stream, Purpose.SENSOR_FAULT, (words[:, 0], words[:, 1]), columns).T

    def require_sensor(self, sensor: int) -> None:
        """`ValueError` if there is no such sensor."""
        count = len(self.sensors.path_m)
        if not 0 <= sensor < count:
            raise ValueError(f"sensor faults: there is no sensor {sensor}; they are numbered from 0 to {count - 1}")


class SensorFault(Protocol):
    """What may happen to pulse pairs between wheel and regulator."""

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """What is heard of `pairs`; `ValueError` for a sensor that does not exist."""
        ...


def together(sensors: PointSensors, faults: Sequence[SensorFault]) -> Faults:
    """`faults` one after the other, for `PassageLoop.run`."""

    def heard(pairs: HeardPairs, draws: Draws) -> HeardPairs:
        for fault in faults:
            pairs = fault.heard(pairs, Scene(sensors, draws))
        return pairs

    return heard


@dataclass(frozen=True)
class DeadSensor:
    """Nothing is heard from `sensor`."""

    sensor: int

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """Without its pairs."""
        scene.require_sensor(self.sensor)
        return without(pairs, of_sensor(pairs, self.sensor))


@dataclass(frozen=True)
class StuckReading:
    """`sensor` tells each wheel, but always the same speed, as of the last cut that it measured."""

    sensor: int
    speed_m_s: float

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """With that speed."""
        scene.require_sensor(self.sensor)
        return replace(pairs, told_m_s=np.where(of_sensor(pairs, self.sensor), self.speed_m_s, pairs.told_m_s))


@dataclass(frozen=True)
class ReversedSensor:
    """The coils of `sensor` are wired the wrong way round: it tells each wheel as one that rolls backwards."""

    sensor: int

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """With a negative speed: no rule and no tracker takes it, whatever its size."""
        return StuckReading(self.sensor, -1.0).heard(pairs, scene)


@dataclass(frozen=True)
class SwappedSensors:
    """The wires of `sensor` and of the one behind it are swapped: each is heard under the number of the other."""

    sensor: int

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """With the numbers exchanged."""
        here, next_one = self.sensor, self.sensor + 1
        scene.require_sensor(here)
        scene.require_sensor(next_one)
        number = pairs.sensor
        return replace(pairs, sensor=np.where(number == here, next_one, np.where(number == next_one, here, number)))


@dataclass(frozen=True)
class LateSensor:
    """What `sensor` tells comes `delay_s` later; the speed is right."""

    sensor: int
    delay_s: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.delay_s <= 60.0:
            raise ValueError(f"sensor faults: delay_s is {self.delay_s!r}; it must be from 0 to 60 s")

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """Later."""
        scene.require_sensor(self.sensor)
        return replace(pairs, after_s=pairs.after_s + np.where(of_sensor(pairs, self.sensor), self.delay_s, 0.0))


@dataclass(frozen=True)
class RepeatedPulses:
    """Each pair of `sensor`, or of all, comes again `times` times, `spacing_s` apart: double pulses, chatter."""

    sensor: int | None
    times: int
    spacing_s: float

    def __post_init__(self) -> None:
        if not (1 <= self.times <= 100 and 0.0 < self.spacing_s <= 60.0):
            raise ValueError("sensor faults: pulses are repeated 1 to 100 times, more than 0 and at most 60 s apart")

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """With the repeated pairs."""
        if self.sensor is not None:
            scene.require_sensor(self.sensor)
        again = of_sensor(pairs, self.sensor)
        kept = taken(pairs, again)
        for time in range(1, self.times + 1):
            pairs = also(pairs, replace(kept, after_s=kept.after_s + time * self.spacing_s))
        return pairs


@dataclass(frozen=True)
class MissedPulses:
    """Each pair of `sensor`, or of all, is lost with `probability`, each by itself."""

    probability: float
    sensor: int | None = None
    stream: int = 0

    def __post_init__(self) -> None:
        if not 0.0 <= self.probability <= 1.0:
            raise ValueError(f"sensor faults: probability is {self.probability!r}; it must be from 0 to 1")

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """Without the lost ones."""
        if self.sensor is not None:
            scene.require_sensor(self.sensor)
        lost = scene.uniform(self.stream, len(pairs.sensor)) < self.probability
        return without(pairs, lost & of_sensor(pairs, self.sensor))


@dataclass(frozen=True)
class SpuriousPulses:
    """`count` pairs that no wheel gave: from any sensor, at any time of the first `within_s`, any speed of a range."""

    count: int
    within_s: float = 15.0
    speed_m_s: tuple[float, float] = (0.5, 8.0)
    stream: int = 1

    def __post_init__(self) -> None:
        if not (1 <= self.count <= 100 and 0.0 < self.within_s <= 300.0):
            raise ValueError("sensor faults: 1 to 100 spurious pulses within at most 300 s are possible")

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """With the false pairs: a row for every sensor, of which each pass hears one."""
        sensors = len(scene.sensors.path_m)
        u = scene.uniform(self.stream, 3 * self.count)
        low, high = self.speed_m_s
        for false in range(self.count):
            which, time, speed = u[:, 3 * false : 3 * false + 3].T
            chosen = np.floor(which * sensors)[:, None] == np.arange(sensors)
            after = np.where(chosen, (time * self.within_s)[:, None], np.nan)
            told = np.broadcast_to((low + speed * (high - low))[:, None], after.shape)
            pairs = also(pairs, HeardPairs(np.full(sensors, BY_THE_CLOCK), np.arange(sensors), after, told.copy()))
        return pairs


@dataclass(frozen=True)
class LoneAxle:
    """An axle that is not of the cut rolls over all sensors with `speed_m_s`.

    It is at the first sensor `ahead_s` before the pass begins, so before the cut; negative: that much later.
    """

    ahead_s: float
    speed_m_s: float

    def __post_init__(self) -> None:
        if not (abs(self.ahead_s) <= -WATCHED_FROM_S and 0.1 <= self.speed_m_s <= 40.0):
            raise ValueError("sensor faults: a lone axle comes within 60 s of the cut, with 0.1 to 40 m/s")

    def heard(self, pairs: HeardPairs, scene: Scene) -> HeardPairs:
        """With a pair of every sensor."""
        path = np.array(scene.sensors.path_m)
        after = (path - path[0]) / self.speed_m_s - self.ahead_s
        every = np.repeat(after[None], len(pairs), axis=0)
        by_the_clock = np.full(len(path), BY_THE_CLOCK)
        return also(pairs, HeardPairs(by_the_clock, np.arange(len(path)), every, np.full_like(every, self.speed_m_s)))


def of_sensor(pairs: HeardPairs, sensor: int | None) -> Bools:
    """Marks the rows that are heard from `sensor`, or all, (R,)."""
    return np.ones(len(pairs.sensor), dtype=np.bool_) if sensor is None else pairs.sensor == sensor


def without(pairs: HeardPairs, lost: Bools) -> HeardPairs:
    """The pairs but those that `lost`, of a shape like (n, R), marks."""
    return replace(pairs, after_s=np.where(lost, np.nan, pairs.after_s))


def taken(pairs: HeardPairs, rows: Bools) -> HeardPairs:
    """The rows alone that `rows` (R,) marks."""
    return HeardPairs(pairs.source[rows], pairs.sensor[rows], pairs.after_s[:, rows], pairs.told_m_s[:, rows])


def also(pairs: HeardPairs, more: HeardPairs) -> HeardPairs:
    """These rows and those of `more`, of the same passes, in the order that the kernel wants."""
    source = np.concatenate([pairs.source, more.source])
    order = np.argsort(np.where(source == BY_THE_CLOCK, np.iinfo(np.int64).max, source), kind="stable")
    return HeardPairs(
        source[order],
        np.concatenate([pairs.sensor, more.sensor])[order],
        np.concatenate([pairs.after_s, more.after_s], axis=1)[:, order],
        np.concatenate([pairs.told_m_s, more.told_m_s], axis=1)[:, order],
    )
