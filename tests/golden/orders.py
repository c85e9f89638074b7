"""Every command in its smallest form, in the order in which one needs the results of another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from synth.cli.file_kinds import FILE_KINDS
from tests.sweep.conftest import MEASURED as MEASURED_SPEED
from tests.sweep.conftest import PLANT, SWEEP
from tests.synth.hump.making.test_hump_make import SMALL as SHORT
from tests.system.conftest import CLASS, SECOND_CLASS
from tests.system.test_aim import SMALL as AIM
from tests.system.test_computer import FEW as COMPUTER
from tests.system.test_hump_trials import SMALL as TRIAL

SENSORS = """\
[sensors]
path_m = [-4.5, 0.0, 4.0, 8.0, 12.0, 16.0, 22.5]
"""
DUMPER = CLASS.replace("rnz-2m-park", "rnz-2m-dumper").replace("[1.5]", "[2.0]").replace("high_m_s = 4.0", "")
YARD = """\
trial = "trial.toml"
logs = "validated/log.h5"
config = "park.toml"
[cost]
number = 20
[[position]]
name = "421"
retarder = 421
"""

INPUTS: Mapping[str, str] = {
    "park.toml": CLASS + SECOND_CLASS,
    "measured.toml": CLASS + MEASURED_SPEED,
    "any-time.toml": f'{CLASS}{MEASURED_SPEED}commands = "any_time"\n',
    "dumper.toml": DUMPER,
    "sensors.toml": DUMPER + SENSORS,
    "sweep.toml": PLANT + SWEEP,
    "aim.toml": AIM,
    "short.toml": SHORT,
    "trial.toml": TRIAL,
    "yard.toml": YARD,
    "computer.toml": COMPUTER,
}
"""The configurations, by the names of their files."""


@dataclass(frozen=True)
class Order:
    """`words` after the name of the program; `output`: the folder or file that it writes, "" for none."""

    words: str
    output: str = ""

    @property
    def line(self) -> str:
        """As it is typed."""
        return f"{self.words} -o {self.output}" if self.output else self.words


BOOK, PARK = "park/book.h5", "--config park.toml"
LOG = "validated/log.h5 --config park.toml"
PASSAGES = "passages/tables/gondola-4-22t-to-2-m-s.json"

ORDERS: tuple[Order, ...] = (
    Order("init"),
    *(Order(f"init {kind.word}") for kind in FILE_KINDS),
    *(Order(f"init {kind.word} --schema") for kind in FILE_KINDS),
    Order("init --list"),
    Order("init --for trial.toml --position-number 3"),
    Order("tune park.toml --workers 1", "park"),
    Order("tune measured.toml --workers 1", "measured"),
    Order("tune any-time.toml --workers 1", "any-time"),
    Order(f"validate {BOOK} {PARK} --log log.h5 --log-passes 150", "validated"),
    Order(f"verify {BOOK}", "verified"),
    Order("qualify", "qualified"),
    Order(f"inspect {BOOK} {PARK}", "pictures"),
    Order(f"explore {BOOK} {PARK}", "explored"),
    Order(f"loop {BOOK} {PARK}", "loops"),
    *(Order(f"export {BOOK} --format {form}", f"export-{form}") for form in ("json", "c", "st", "csv", "fmu", "fmu2")),
    Order(f"export {BOOK} --format st --split --self-test small --correction 0.2 --prefix PARK", "export-split"),
    *(
        Order(f"export {BOOK} --format {form} --self-test small", f"export-{form}")
        for form in ("plcopen", "twincat", "scl")
    ),
    Order("export any-time/book.h5 --format c", "export-any-time"),
    Order(f"identify {LOG}", "identified"),
    Order(f"watch {LOG}", "watched"),
    Order(f"replay {LOG} --table measured/book.h5 --own {BOOK}", "replayed"),
    Order(f"retune {LOG} --table {BOOK}", "retuned"),
    Order("hardware measured.toml --workers 1", "permissions"),
    Order("sensitivity measured.toml --points 200 --passes 100", "sensitivity"),
    Order("sweep run sweep.toml --workers 1", "swept"),
    Order("sweep status swept"),
    Order("sweep failed swept"),
    Order("tune sensors.toml --workers 1", "passages"),
    Order(f"inspect {PASSAGES}"),
    Order(f"export {PASSAGES} --format c", "export-passages-c"),
    Order(f"export {PASSAGES} --format st", "export-passages-st"),
    Order("sensors dumper.toml --sensors 4-5 --workers 1", "planned"),
    Order("aim aim.toml", "aimed"),
    Order("aim aim.toml --hump medium --track 7", "aimed-at-7"),
    Order("hump make short.toml", "made"),
    Order("hump check medium"),
    Order("hump routes medium"),
    Order("hump draw medium", "drawn"),
    Order("hump export medium --format railml", "hump-railml"),
    Order("hump simulate trial.toml", "humped"),
    Order("hump simulate humped/inputs/config.toml", "humped"),
    Order("hump simulate trial.toml --trains 2", "humped-short"),
    Order("hump compare humped humped-short", "compared"),
    Order("hump design trial.toml --speed 1.5", "design"),
    Order("hump capacity trial.toml --speeds 1.7,2.6 --exit-std 0.3,0.1 --trains 2", "capacity"),
    Order("hump speed trial.toml", "speed"),
    Order("hump watch yard.toml", "watched-yard"),
    Order("computer computer.toml", "computed"),
)
