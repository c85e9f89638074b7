"""What [hump-computer-1970s] tells of its control computer beside what the same formulas give here; its losses by
failures, maintenance interval and pay-back worked through again.

Losses by failures, maintenance interval and pay-back of the published control computer, worked through again. The
source tells neither failure rate nor prices but Su, 1.3 to 5 thousand roubles an hour. Su = 5, λ = 0.0024/h and checks
every 2.5 h are one set that gives its loss of a single computer; nothing else is fitted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from scripts.studies.control_computer.published_sizes import PublishedSizes, published_sizes
from scripts.studies.control_computer.published_speeds import FAST_OPERATIONS, PublishedSpeeds, published_speeds
from scripts.studies.study import MarkdownTable, Tell, table
from synth.computer.economics.investment import pay_back, yearly_effect
from synth.computer.reliability.four_states import HOURS_PER_YEAR, FourStates, HourPrices, StateShares, yearly_loss
from synth.computer.reliability.maintenance import CheckedComputer, Duplex, single_availability

UNNOTICED_K_RUB_PER_H = 5.0
FAILURE_PER_H, INTERVAL_H = 0.0024, 2.5
"""λ is assumed; x is the middle of the published 2 to 3 h."""

CHECK_H = 0.25
"""Of a duplex, assumed."""

DUPLEX_K_RUB, DUPLEX_PERIOD_H = 1.5, 4.2
PUBLISHED_INTERVALS_H = (2.0, 3.0)
SAVINGS_K_RUB, CAPITAL_K_RUB, NORMATIVE = (40.0, 85.0), (240.0, 1000.0), (0.12, 0.15)
INVESTMENTS_K_RUB, EFFECTS_K_RUB = (800.0 / 3.0, 160.0), (200.0, 80.0)
"""Investments are not told: these give the published 2 and 4 years for the published effects."""


@dataclass(frozen=True)
class PublishedLosses:
    """Thousand roubles a year unless the name tells another unit.

    `single`: one computer with checks at fixed times; `chain_ratio`: how much more the chain with random checks of the
    same rate tells. `duplex`: a pair with checks of no length at the same period; `duplex_period_h`: the period at
    which it loses the published 1.5; `longest_check_min`: with longer checks no period does; `duplex_with_checks`: with
    checks of 0.25 h every 4.2 h. `worth_h`: τSc/Su that make 2, 2.5 and 3 h the best interval. `effects`: yearly
    effects of the published savings at both normative efficiencies; `pay_back_years` with the assumed investments.
    """

    single: float
    chain_ratio: float
    duplex: float
    duplex_period_h: float
    longest_check_min: float
    duplex_with_checks: float
    worth_h: tuple[float, float, float]
    effects: tuple[float, float, float, float]
    pay_back_years: tuple[float, float]


def published_losses() -> PublishedLosses:
    """All of them."""
    pair = Duplex(FAILURE_PER_H, 0.0)
    needed = DUPLEX_K_RUB / (HOURS_PER_YEAR * UNNOTICED_K_RUB_PER_H)
    alone = 1.0 - float(single_availability(FAILURE_PER_H, 0.0, INTERVAL_H))
    chain = FourStates(FAILURE_PER_H, 0.0, 1.0 / INTERVAL_H, 4.0, 0.5).stationary()
    low, middle, high = (check_worth_h(x) for x in (PUBLISHED_INTERVALS_H[0], INTERVAL_H, PUBLISHED_INTERVALS_H[1]))
    effects = [
        yearly_effect(e, k, n, 0.0) for n in NORMATIVE for e, k in zip(SAVINGS_K_RUB, CAPITAL_K_RUB, strict=True)
    ]
    first, second = (pay_back(a, b).years for a, b in zip(INVESTMENTS_K_RUB, EFFECTS_K_RUB, strict=True))
    assert first is not None
    assert second is not None
    return PublishedLosses(
        single=loss_k_rub(alone),
        chain_ratio=chain.failed_unnoticed / (chain.ready + chain.failed_unnoticed) / alone,
        duplex=loss_k_rub(1.0 - float(pair.availability(INTERVAL_H))),
        duplex_period_h=pair.longest_period_h(1.0 - needed),
        longest_check_min=60.0 * 2.0 * needed / FAILURE_PER_H,
        duplex_with_checks=loss_k_rub(1.0 - float(Duplex(FAILURE_PER_H, CHECK_H).availability(DUPLEX_PERIOD_H))),
        worth_h=(low, middle, high),
        effects=(effects[0], effects[1], effects[2], effects[3]),
        pay_back_years=(first, second),
    )


def loss_k_rub(unnoticed: float) -> float:
    """A year of failures that are unnoticed for this share of the time."""
    shares = StateShares(1.0 - unnoticed, unnoticed, 0.0, 0.0)
    return yearly_loss(shares, HourPrices(UNNOTICED_K_RUB_PER_H, 0.0)).total


def check_worth_h(interval_h: float) -> float:
    """The price of a check, in hours of an unnoticed failure, that makes `interval_h` the best interval."""
    from scipy.optimize import brentq

    def too_long(worth_h: float) -> float:
        computer = CheckedComputer(FAILURE_PER_H, worth_h, UNNOTICED_K_RUB_PER_H, UNNOTICED_K_RUB_PER_H)
        return computer.best_useful_h - interval_h

    return float(brentq(too_long, 1e-6, 1.0, xtol=1e-12))


Row = tuple[str, str, str, str]
"""What, published, ours, remark."""


@dataclass(frozen=True)
class Published:
    """All three parts."""

    speeds: PublishedSpeeds
    sizes: PublishedSizes
    losses: PublishedLosses

    def tables(self) -> dict[str, MarkdownTable]:
        """`published` and those of the parts."""
        rows = (*speed_rows(self.speeds), *size_rows(self.sizes), *loss_rows(self.losses))
        beside = table("published figures beside ours", ("figure", "published", "ours", "remark"), rows)
        return {"published": beside, **self.speeds.tables(), **self.sizes.tables()}


def published(tell: Tell) -> Published:
    """All parts."""
    found = Published(published_speeds(), published_sizes(), published_losses())
    tell("published figures worked through")
    return found


def speed_rows(found: PublishedSpeeds) -> Iterator[Row]:
    """Speeds, use of the cycle, waits, priorities."""
    opened, closed = found.cyclic
    laws = {law.law: law for law in found.laws}
    constant, exponential = laws["constant"], laws["exponential"]
    yield ("cyclic service in open loop, op/s", "20 000", thousands(opened.speed_op_s),
           "10 000 operations in each second, half of it for the work")  # fmt: skip
    yield ("cyclic service with feedback, op/s", "1 000 000", thousands(closed.speed_op_s),
           "500 000 operations in each second, half of it for the work")  # fmt: skip
    low, high = closed.with_checks[0], closed.without_checks[1]
    less, more = opened.with_checks[0], opened.without_checks[1]
    yield (
        "share of that speed that is used, %", "7–8", f"{100 * closed.queue_share:.1f}",
        f"with {FAST_OPERATIONS:.0f} operations as in the next rows; 7–8 % ask for {less:.0f} to {more:.0f} "
        f"operations a request in open loop, {low:.0f} to {high:.0f} with feedback: another mix of tasks",
    )  # fmt: skip
    yield ("on demand, 1 500 op/s: W, s", "< 0.01", f"0.01 with {constant.most_by_mean:.0f} operations",
           f"constant; {exponential.most_by_mean:.0f} with exponential service: the source tells none")  # fmt: skip
    yield ("1 500 op/s: P(W > 0.1 s)", "≤ 0.001", f"0.001 with {constant.most_by_tail:.0f} operations",
           f"constant service; {exponential.most_by_tail:.0f} with exponential")  # fmt: skip
    yield (
        "120 000 op/s: W, s",
        "< 0.01",
        f"{constant.mean_s:.4f}",
        f"exponential {exponential.mean_s:.4f}: both keep it",
    )
    yield ("120 000 op/s: P(W > 0.1 s)", "≤ 0.001", f"{constant.long_share:.2g}",
           f"exponential {exponential.long_share:.2g}: too much; Erlang keeps it from {found.erlang_stages} stages on",
           )  # fmt: skip
    means = [each.mean_s for each in found.priorities if each.order != "absolute"]
    speeds, rare = found.needed_by_order.values(), max(each.long_share for each in found.priorities)
    yield (
        "priorities", "hardly matter", f"waits {1e3 * min(means):.3f} to {1e3 * max(means):.3f} ms",
        f"three classes, relative; speeds for W ≤ 0.01 s differ by {100 * (max(speeds) / min(speeds) - 1):.0f} %; but "
        f"P(W > 0.1 s) of the last class is {rare:.2g}, above the claim",
    )  # fmt: skip


def size_rows(found: PublishedSizes) -> Iterator[Row]:
    """Words, channels, memory."""
    yield "word, bits", "16", str(found.word_bits), "16 is the next word that is built"
    ours = next(c for c in found.channels if c.hump == "large")
    theirs = found.channels[0]
    for name in ("digital_in", "analog_in", "digital_out", "analog_out"):
        least = "≥ " if name.endswith("in") else ""
        yield (f"{name.replace('_', ' ')}puts, large hump", f"{least}{getattr(theirs, name)}", str(getattr(ours, name)),
               CHANNEL_REMARKS[name])  # fmt: skip
    yield "fixed memory, words", "2 000", thousands(found.fixed_words), "rows of its table added up"
    yield ("working memory, words", "2 000", thousands(found.working_words),
           "by number; one width cannot be read in the print")  # fmt: skip


CHANNEL_REMARKS = {
    "digital_in": "an upper bound: counters of one joint are counted for both neighbours",
    "analog_in": "ours has a gauge a braking zone and a radar a position; the source tells no rule",
    "digital_out": "ours commands stages by valves",
    "analog_out": "the source commands retarders by analog values",
}


def loss_rows(found: PublishedLosses) -> Iterator[Row]:
    """Losses, intervals, pay-back."""
    low, _, high = found.worth_h
    yield ("loss of one computer, thousand roubles a year", "≤ 130", f"{found.single:.0f}",
           f"Su = 5, λ = 0.0024/h (assumed), checks every 2.5 h; the chain, whose checks come at random, tells "
           f"{found.chain_ratio:.1f} times as much")  # fmt: skip
    yield (
        "loss of a duplex, thousand roubles a year", "1.5", f"{found.duplex:.2f}",
        f"the same period, checks of no length; 1.5 at a period of {found.duplex_period_h:.1f} h; "
        f"{found.duplex_with_checks:.0f} with checks of 0.25 h, and with checks above {found.longest_check_min:.1f} "
        "min no period gives 1.5",
    )  # fmt: skip
    yield ("maintenance interval, h", "2–3", "2–3",
           f"only if a check costs as much as {low:.4f} to {high:.4f} h of an unnoticed failure")  # fmt: skip
    least, most = min(found.effects), max(found.effects)
    yield ("effect, thousand roubles a year", "80–200", f"{least:.0f}–{most:.0f}",
           "from its savings 40–85 and released capital 240–1000, normative efficiency 0.12–0.15")  # fmt: skip
    early, late = found.pay_back_years
    yield (
        "pay-back, years",
        "2–4",
        f"{early:.0f}–{late:.0f}",
        "with investments of 267 and 160: the source tells none",
    )


def thousands(value: float) -> str:
    """'1 000 000'."""
    return f"{value:,.0f}".replace(",", " ")
