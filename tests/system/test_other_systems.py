"""Windows and macOS: the program runs where none of what POSIX or Linux alone has can be seen by its own code.

Not a test on these systems themselves: the libraries below see the real one.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest

from synth.cli.guide import GUIDES
from tests.system.conftest import CLASS
from tests.system.test_hump_trials import SMALL

HIDDEN_MODULES = "fcntl grp posix pty pwd readline resource syslog termios tty"
HIDDEN_NAMES = {
    "os": "chown chroot ctermid fchdir fchmod fchown fork forkpty getegid geteuid getgid getgroups getloadavg getpgid "
    "getpriority getuid initgroups killpg lchown mkfifo mknod nice openpty posix_fadvise posix_fallocate posix_spawn "
    "posix_spawnp pread preadv pwrite pwritev readv sched_getaffinity sched_setaffinity sched_yield sendfile setpgid "
    "setpriority setsid statvfs sync sysconf tcgetpgrp tcsetpgrp ttyname uname wait3 wait4 writev O_NONBLOCK O_CLOEXEC "
    "O_DIRECTORY O_NOFOLLOW O_TMPFILE O_SYNC",
    "signal": "SIGALRM SIGCHLD SIGHUP SIGKILL SIGPIPE SIGQUIT SIGTSTP SIGUSR1 SIGUSR2 SIGXCPU alarm pause pthread_kill "
    "pthread_sigmask setitimer sigpending sigwait",
}
"""What Windows has not."""

HIDDEN_ON_MACOS = {"os": "sched_getaffinity O_TMPFILE posix_fadvise"}

SYSTEMS = {
    "windows": {"modules": HIDDEN_MODULES, "names": HIDDEN_NAMES, "platform": ""},
    "macos": {"modules": "", "names": HIDDEN_ON_MACOS, "platform": "darwin"},
}

SITE = """
import builtins, io, json, os, sys

TOLD = json.loads(os.environ["HIDDEN"])
OWN = ("synth", "plant_models", "tuning_tables")
MODULES = set(TOLD["modules"].split())
NAMES = {module: set(names.split()) for module, names in TOLD["names"].items()}


class Seen:
    def __init__(self, real, hidden, changed):
        vars(self).update(_real=real, _hidden=hidden, _changed=changed)

    def __getattr__(self, name):
        if name in self._hidden:
            raise AttributeError(f"module {self._real.__name__!r} has no attribute {name!r}")
        return self._changed[name] if name in self._changed else getattr(self._real, name)

    def __setattr__(self, name, value):
        setattr(self._real, name, value)


SEEN = {name: Seen(__import__(name), hidden, {}) for name, hidden in NAMES.items()}
if TOLD["platform"]:
    SEEN["sys"] = Seen(sys, set(), {"platform": TOLD["platform"]})
imported, opened = builtins.__import__, io.open


def import_seen(name, globals=None, locals=None, fromlist=(), level=0):
    importer = (globals or {}).get("__name__", "").partition(".")[0]
    if level == 0 and importer in OWN:
        if name in MODULES:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
        if name in SEEN or (name.partition(".")[0] in SEEN and not fromlist):
            return SEEN[name.partition(".")[0]]
    return imported(name, globals, locals, fromlist, level)


def open_seen(file, *arguments, **options):
    caller = sys._getframe(1).f_globals.get("__name__", "").partition(".")[0]
    if caller in OWN + ("pathlib",) and str(file).startswith("/proc/") and str(file) != "/proc/cpuinfo":
        raise FileNotFoundError(2, "No such file or directory", str(file))
    return opened(file, *arguments, **options)


builtins.__import__ = import_seen
builtins.open = io.open = open_seen
"""
"""Comes before all else in each process of the program, those that it starts too. It shows the name of the processor:
without it all kernels would be compiled once more, for a processor without a name."""

PROGRAM = "from synth.cli import script; script()"

COMMANDS = """
import contextlib, io, json, sys
from synth.cli import main

told = []
for words in json.loads(sys.argv[1]):
    with contextlib.redirect_stdout(io.StringIO()) as out:
        code = main(words)
    assert code == 0, (words, code)
    told.append(out.getvalue())
print(json.dumps(told))
"""

WITH_LEAST = pytest.mark.parametrize("elsewhere", ["windows"], indirect=True)
"""For whole runs: Windows has nothing that macOS lacks, and no code asks which of both it is on."""


class Elsewhere:
    """The program as another system has it."""

    def __init__(self, system: str, folder: Path) -> None:
        self.folder = folder
        (folder / "site").mkdir()
        (folder / "site" / "sitecustomize.py").write_text(SITE)
        hidden = {"HIDDEN": json.dumps(SYSTEMS[system]), "PYTHONPATH": str(folder / "site")}
        self.environment = {**os.environ, **hidden}

    def python(self, source: str, *arguments: object) -> subprocess.CompletedProcess[str]:
        """Run `source` with `arguments`."""
        return subprocess.run(
            [sys.executable, "-c", source, *map(str, arguments)],
            env=self.environment, cwd=self.folder, capture_output=True, text=True, timeout=300, check=False,
        )  # fmt: skip

    def run(self, *arguments: object) -> str:
        """What the command prints; it must end well."""
        ran = self.python(PROGRAM, *arguments)
        assert ran.returncode == 0, ran.stderr
        return ran.stdout

    def run_each(self, *commands: Sequence[str]) -> list[str]:
        """What each of these prints, given in one process; all must end well."""
        ran = self.python(COMMANDS, json.dumps(commands))
        assert ran.returncode == 0, ran.stderr
        told: list[str] = json.loads(ran.stdout)
        return told


@pytest.fixture(scope="module", params=list(SYSTEMS))
def elsewhere(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Elsewhere:
    return Elsewhere(request.param, tmp_path_factory.mktemp(request.param))


def test_nothing_is_seen(elsewhere: Elsewhere) -> None:
    """Else the other tests would show nothing."""
    (elsewhere.folder / "site" / "synth.py").write_text(
        "import os, sys\nprint(hasattr(os, 'sched_getaffinity'), hasattr(os, 'getpid'), sys.platform)\n"
        "try:\n    import fcntl\n    print('fcntl')\nexcept ImportError:\n    print('none')\n"
        "try:\n    open('/proc/meminfo')\nexcept OSError:\n    print('no proc')\n"
    )
    ran = elsewhere.python("import synth")
    (elsewhere.folder / "site" / "synth.py").unlink()
    is_mac = "macos" in str(elsewhere.folder)
    told = f"False True {'darwin' if is_mac else sys.platform}\n{'fcntl' if is_mac else 'none'}\nno proc\n"
    assert (ran.stdout, ran.stderr) == (told, "")


def test_every_command_helps(elsewhere: Elsewhere) -> None:
    words = [[*guide.words.split(), name, "--help"] for guide in GUIDES.values() for names in guide.sections.values()
             for name in names]  # fmt: skip
    ran = elsewhere.python(COMMANDS, json.dumps(words))
    assert (ran.returncode, ran.stderr) == (0, "")
    assert all("Usage" in told for told in json.loads(ran.stdout))


def test_windows_lacks_all_that_macos_lacks() -> None:
    assert all(set(names.split()) <= set(HIDDEN_NAMES[module].split()) for module, names in HIDDEN_ON_MACOS.items())


@WITH_LEAST
def test_tables_are_made_and_checked(elsewhere: Elsewhere) -> None:
    """Several workers, and pictures by several processes; then two runs into one directory."""
    (elsewhere.folder / "one.toml").write_text(CLASS)
    elsewhere.run("tune", "one.toml", "-o", "tuned", "--workers", 2)
    logged = "--config one.toml --log log.h5 --log-passes 100"
    validated, verified, inspected = elsewhere.run_each(
        f"validate tuned {logged} -o validated --json".split(), ["verify", "tuned", "--json"], ["inspect", "tuned"]
    )
    assert json.loads(validated)["accepted"] is True
    assert json.loads(verified)["confirmed"] is True
    assert "its CRC-32 is right" in inspected
    held = elsewhere.python(
        "from pathlib import Path\nfrom synth.frame.own_files import held\nfrom synth.cli import main\n"
        "with held(Path('tuned')):\n    raise SystemExit(main(['tune', 'one.toml', '-o', 'tuned']))"
    )
    assert held.returncode == 2
    assert "another tune is writing there" in held.stderr


@WITH_LEAST
def test_trains_are_humped(elsewhere: Elsewhere) -> None:
    (elsewhere.folder / "trial.toml").write_text(SMALL)
    assert "humped" in elsewhere.run("hump", "simulate", "trial.toml", "-o", "humped")
