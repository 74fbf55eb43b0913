"""Programs of FX-family PLCs: check them, run them in virtual time, emit C and Rust.

>>> import rungc
>>> plc = rungc.from_list("LD X000\nOUT Y000\nEND\n").start()
>>> plc["X000"] = True
>>> plc.run(ms=20)
>>> plc["Y000"]
True
"""

from ._rungc import (
    Answer,
    DeviceError,
    Diagnostic,
    Error,
    Output,
    Plc,
    Program,
    Project,
    Rejected,
    Snapshot,
    __version__,
    from_list,
    open,
)

__all__ = [
    "Answer",
    "DeviceError",
    "Diagnostic",
    "Error",
    "Output",
    "Plc",
    "Program",
    "Project",
    "Rejected",
    "Snapshot",
    "__version__",
    "from_list",
    "open",
]
