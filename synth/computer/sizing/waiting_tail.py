"""How probable a long wait is: P(W > t) of a task, exact where a closed form is known, else by inversion."""

from __future__ import annotations

import math

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.computer.sizing.demand_service import Discipline
from synth.computer.sizing.laplace_inversion import Inverted, inverted
from synth.computer.sizing.service_law import Complexes, Constant, Exponential
from synth.computer.sizing.task import Stream, require_not_overloaded
from synth.computer.sizing.waiting_transform import WaitLaw, sojourn_law, start_law

ROUNDING = 1e-14
"""Of a closed form that adds terms of one sign."""

MOST_SERVICES = 20_000
"""Longest wait, in services, for which the sum of the closed form is made; it has as many terms."""


def start_tail(streams: tuple[Stream, ...], discipline: Discipline, task: str, wait_s: float) -> Inverted:
    """P(time from request to begin of service > `wait_s`) of `task`, with its error.

    Closed forms where `task` is alone and its service constant or exponential. Raises `PlantError` if ρ ≥ 1.
    """
    require_not_overloaded(streams)
    if len(streams) == 1 and streams[0].name == task:
        rate_per_s, service = streams[0].rate_per_s, streams[0].service
        if isinstance(service, Exponential):
            return Inverted(exponential_tail(rate_per_s, service.mean, wait_s), ROUNDING)
        if isinstance(service, Constant) and wait_s < MOST_SERVICES * service.mean:
            return Inverted(constant_tail(rate_per_s, service.mean, wait_s), ROUNDING)
    return survival(start_law(streams, discipline, task), wait_s)


def sojourn_tail(streams: tuple[Stream, ...], discipline: Discipline, task: str, time_s: float) -> Inverted:
    """P(time from request to end > `time_s`) of `task`, with its error: how often a deadline is missed."""
    return survival(sojourn_law(streams, discipline, task), time_s)


def survival(law: WaitLaw, time_s: float) -> Inverted:
    """P(T > `time_s`), from the transform (1 − E[e^(−sT)]) / s of the survival function."""
    if time_s == 0.0:
        return Inverted(law.positive_share, ROUNDING)

    def transform(s: Complexes) -> Complexes:
        return (1.0 - law.transform(s)) / s

    found = inverted(transform, time_s)
    return Inverted(min(max(found.value, 0.0), 1.0), found.error)


def exponential_tail(rate_per_s: float, service_s: float, wait_s: float) -> float:
    """P(W > t) = ρ e^(−(μ − λ)t): exponential service, one task."""
    load = rate_per_s * service_s
    return load * math.exp(-(1.0 - load) * wait_s / service_s)


def constant_tail(rate_per_s: float, service_s: float, wait_s: float) -> float:
    """P(W > t) for constant service D, one task: 1 − e^(−λu) Σ_{j<k} Q_{k−1−j} (λu)^j/j! with u = kD − t in (0, D].

    Q_n = P(at most n wait). All terms are positive (Franx, Operations Research Letters 29, 2001, p. 221), where
    Erlang's form, Σ_j (1 − ρ) e^(λ(t − jD)) (−λ(t − jD))^j/j!, loses all digits for long waits.
    """
    from scipy.special import gammaln, xlogy

    services = math.floor(wait_s / service_s) + 1
    rest = rate_per_s * (services * service_s - wait_s)
    waiting = np.cumsum(requests_present(rate_per_s * service_s, services + 1))[1:]
    index = np.arange(services)
    coming = np.exp(xlogy(index, rest) - rest - gammaln(index + 1.0))
    return float(max(0.0, 1.0 - coming @ waiting[services - 1 :: -1]))


def requests_present(load: float, most: int) -> Floats:
    """π_n, n = 0 … `most`: the law of the number of requests in the system, constant service, load ρ.

    As often as the number rises above n it falls to n: with A the requests that come during a service,
    π_{n+1} P(A = 0) = π_0 P(A > n) + Σ_{j=1}^{n} π_j P(A > n + 1 − j). No term is negative.
    """
    from scipy.special import pdtrc

    more = pdtrc(np.arange(most + 1), load)
    present = np.empty(most + 1)
    present[0] = 1.0 - load
    for n in range(most):
        present[n + 1] = (present[0] * more[n] + present[1 : n + 1] @ more[n:0:-1]) * math.exp(load)
    return present
