"""The fixture `plc` for tests with pytest, and what a failed test shows of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from . import Plc, open


class Recorded:
    """A PLC, and what a test has done with it."""

    def __init__(self, plc: Plc):
        self._plc = plc
        self._names: list[str] = []
        self._log: list[tuple[int, str, object]] = []

    def __getattr__(self, name):
        return getattr(self._plc, name)

    def __setattr__(self, name, value):
        if name.startswith("_"):
            super().__setattr__(name, value)
        else:
            setattr(self._plc, name, value)

    def __getitem__(self, name):
        value = self._plc[name]
        self._use(name, value)
        return value

    def __setitem__(self, name, value):
        self._plc[name] = value
        self._use(name, value)

    def _use(self, name, value):
        if name not in self._names:
            self._names.append(name)
        self._note(self._plc.now_ms, name, value)

    def _note(self, ms, name, value):
        last = next((v for _, n, v in reversed(self._log) if n == name), None)
        if last != value:
            self._log.append((ms, name, value))

    def run(self, *, ms):
        """Let time pass, and note when the devices that the test uses change."""
        trace = self._plc.trace(self._names, ms=ms)
        for at, now in enumerate(trace["ms"]):
            for name in self._names:
                self._note(now, name, trace[name][at])

    def scan(self, count=1):
        for _ in range(count):
            self._plc.scan()
            for name in self._names:
                self._note(self._plc.now_ms, name, self._plc[name])

    def history(self) -> str:
        """The devices that the test used, and when they changed."""
        rows = [f"{ms:>8} ms  {name} = {_shown(value)}" for ms, name, value in self._log]
        return "\n".join(rows)


def _shown(value):
    return int(value) if isinstance(value, bool) else value


def pytest_configure(config):
    config.addinivalue_line(
        "markers", "rungc(path, model=None): the program that the fixture `plc` runs"
    )


@pytest.fixture
def plc(request):
    """A PLC at power-on, with the program of the marker `rungc`."""
    marker = request.node.get_closest_marker("rungc")
    if marker is None:
        pytest.fail('name the program: @pytest.mark.rungc("motor.il")', pytrace=False)
    path = Path(*marker.args)
    if not path.is_absolute():
        path = request.path.parent / path
    plc = Recorded(open(path, **marker.kwargs).start())
    request.node._rungc = plc
    return plc


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    report = (yield).get_result()
    plc = getattr(item, "_rungc", None)
    if report.when == "call" and report.failed and plc is not None and plc._log:
        report.sections.append(("devices of the PLC", plc.history()))
