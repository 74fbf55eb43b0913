"""The compiled part of rungc."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, final

__version__: str

class Error(Exception):
    """A program or its settings cannot be read."""

class Rejected(Error):
    """A program has errors, which are its argument: a list of Diagnostic."""

class DeviceError(Error, KeyError):
    """A name is that of no device, or a value does not fit the device."""

def open(
    path: str | PathLike[str],
    *,
    model: str | None = None,
    settings: str | PathLike[str] | None = None,
    allow: Sequence[str] = (),
    deny: Sequence[str] = (),
    deny_warnings: bool = False,
) -> Project:
    """Open a program of any format that rungc reads, or the program of a folder.

    model: the PLC, such as "fx3u" or "h2u-mtq"; default: that of rungc.toml, else the one that the program names.
    settings: a rungc.toml; default: the nearest one, in the program's folder or above it.
    allow, deny: codes of warnings that are left out, or that are errors.
    """

def from_list(list: str, *, name: str = "program.il", model: str | None = None) -> Project:
    """An instruction list in memory, without settings."""

@final
class Diagnostic:
    """A finding of a check."""

    @property
    def code(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def severity(self) -> str:
        """note, warning or error."""
    @property
    def message(self) -> str: ...
    @property
    def help(self) -> str | None: ...
    @property
    def file(self) -> str: ...
    @property
    def line(self) -> int | None: ...
    @property
    def column(self) -> int | None: ...
    @property
    def step(self) -> int | None: ...
    @property
    def devices(self) -> list[str]: ...

@final
class Project:
    """A program as its author wrote it, with its settings."""

    @property
    def file(self) -> str: ...
    @property
    def model(self) -> str: ...
    @property
    def comments(self) -> dict[str, str]:
        """Comments by device."""
    def check(self) -> list[Diagnostic]:
        """All that is wrong with the program, as `rungc check` finds it."""
    def compile(self) -> Program:
        """Compile the program; raises Rejected if it has errors."""
    def start(self) -> Plc:
        """Compile the program, and power on a PLC that runs it."""
    def prove(
        self,
        *properties: str,
        assume: Sequence[str] = (),
        free: Sequence[str] = (),
        scan_ms: int | None = None,
        cleared: bool = False,
        effort: int | None = None,
    ) -> list[Answer]:
        """Decide properties, as `rungc verify` does; without any, those of rungc.toml.

        properties: "never Y000 & Y001", "always A", "reachable A", "whenever A then B within 2s", "stays A after B
        until C".
        assume: conditions that hold after every scan.
        free: devices that something outside writes although the program does: "M500", "D100..D109".
        scan_ms: the longest time from one scan to the next; default: that of rungc.toml, else 200.
        cleared: latched devices begin with 0, not with any value.
        effort: limit for each property, the same on every machine; default: that of rungc.toml, else 10000.
        """
    def same_as(
        self,
        older: Project,
        *,
        assume: Sequence[str] = (),
        free: Sequence[str] = (),
        scan_ms: int | None = None,
        cleared: bool = False,
        effort: int | None = None,
    ) -> dict[str, Output]:
        """Whether each output is that of an older program in every run with the same inputs, by name."""
    def why(self, device: str) -> str:
        """What can switch a device: the instructions that write it, with their conditions."""
    def ladder(self, width: int = 100) -> str:
        """The ladder as text."""
    def svg(self) -> str:
        """The ladder as a picture."""
    def _repr_svg_(self) -> str: ...

@final
class Answer:
    """Answer about a property. It is true if the program does what is asked for: proved, or reached."""

    @property
    def text(self) -> str:
        """The property."""
    @property
    def verdict(self) -> str:
        """proved, violated, reached, not reachable, not decided or vacuous."""
    @property
    def assumptions(self) -> list[str]:
        """What the verdict rests on."""
    @property
    def run(self) -> list[dict[str, Any]]:
        """The run that was found, equal scans together: ms, scans, scan_ms, power_on, stop, set, after."""
    def __bool__(self) -> bool: ...

@final
class Output:
    """An output beside that of an older program. It is true if both are proved to be the same."""

    @property
    def verdict(self) -> str:
        """same, differs, not decided or vacuous."""
    @property
    def reason(self) -> str:
        """After how many scans it differs, or why nothing is known."""
    def __bool__(self) -> bool: ...

@final
class Program:
    """A compiled program."""

    @property
    def name(self) -> str: ...
    def emit_c(self) -> dict[str, str]:
        """The program in C99: text by path."""
    def emit_rust(self) -> dict[str, str]:
        """The program as a crate in Rust: text by path."""
    def start(self) -> Plc:
        """Power on a PLC that runs the program."""

@final
class Snapshot:
    """A moment of a PLC."""

@final
class Plc:
    """A PLC that runs in virtual time. Devices are named X000, D0, D0.i32, D0.f32, K4M0, or by comment."""

    def __getitem__(self, name: str, /) -> bool | int | float | str: ...
    def __setitem__(self, name: str, value: bool | int | float, /) -> None: ...
    def run(self, *, ms: int) -> None:
        """Let time pass, with the scans that begin in it. Other threads of Python run meanwhile."""
    def scan(self, count: int = 1) -> None:
        """Execute scans, each with its time."""
    def trace(self, names: Sequence[str], *, ms: int, every: int = 0) -> dict[str, list[Any]]:
        """Run, and record values: at each scan, or every so many milliseconds. "ms" has the times."""
    @property
    def now_ms(self) -> int: ...
    @property
    def running(self) -> bool: ...
    @running.setter
    def running(self, running: bool) -> None: ...
    def power_cycle(self) -> None:
        """Switch the power supply off and on."""
    def force(self, name: str, value: bool | int | float) -> None:
        """Keep a value whatever the program does."""
    def release(self, name: str) -> None:
        """Release a forced device."""
    def why(self, device: str) -> str:
        """Why a device is on or off, with all else as it is now."""
    def errors(self) -> list[dict[str, int]]:
        """Operation errors: code, step, first_ms, times."""
    def save(self) -> Snapshot: ...
    def restore(self, snapshot: Snapshot) -> None: ...
