"""The package as its users call it."""

import threading
import time
from pathlib import Path

import pytest
import rungc

EXAMPLES = Path(__file__).parents[3] / "examples" / "programs"

#: Y000 follows X000 after 3 s.
DELAY = ";! X000 = Start\nLD X000\nOUT T0 K30\nLD T0\nOUT Y000\nEND\n"


def test_a_program_is_opened_checked_and_run():
    project = rungc.open(EXAMPLES / "motor.il")
    assert project.model == "fx3u"
    assert [d for d in project.check() if d.severity == "error"] == []
    plc = project.start()
    plc["X000"] = True
    plc.run(ms=4000)
    assert plc.now_ms == 4000
    assert plc["Y000"] is True


def test_diagnostics_are_objects():
    project = rungc.from_list("LD X000\nOUT Y000\nLD X001\nOUT Y000\nEND\n", name="twice.il")
    (found,) = [d for d in project.check() if d.code == "W0203"]
    assert (found.name, found.severity, found.file) == ("double-coil", "warning", "twice.il")
    assert (found.line, found.column) == (4, 1)
    assert str(found).startswith("twice.il:4:1: warning[W0203]")


def test_programs_with_errors_are_rejected_with_them():
    project = rungc.from_list("OTU Y000\nEND\n")
    with pytest.raises(rungc.Rejected) as raised:
        project.compile()
    (errors,) = raised.value.args
    assert [e.code for e in errors][0] == "E0033"
    with pytest.raises(rungc.Error, match="nothing.il"):
        rungc.open("nothing.il")
    with pytest.raises(rungc.Error, match="fx9"):
        rungc.from_list(DELAY, model="fx9")
    with pytest.raises(rungc.Error, match="no code `W9999`"):
        rungc.open(EXAMPLES / "motor.il", allow=["W9999"])


def test_values_have_the_types_of_their_devices():
    plc = rungc.from_list(DELAY, model="h2u").start()
    plc["Start"] = True
    plc["D0"] = -5
    plc["D10.f32"] = 1.5
    plc["D20.i32"] = 100_000
    assert (plc["X000"], plc["D0"], plc["D10.f32"], plc["D20.i32"]) == (True, -5, 1.5, 100_000)
    for name, value, why in [
        ("Stop", True, "not a device"),
        ("D0", 70_000, "does not fit"),
        ("M8000", False, "each scan sets it"),
        ("X008", True, "octal"),
    ]:
        with pytest.raises(rungc.DeviceError, match=why):
            plc[name] = value
    with pytest.raises(TypeError):
        plc["D0"] = "five"


def test_a_trace_has_a_row_for_each_scan():
    plc = rungc.from_list(DELAY).start()
    plc["Start"] = True
    trace = plc.trace(["Y000", "T0"], ms=4000)
    assert trace["ms"][:3] == [0, 10, 20] and trace["ms"][-1] == 4000
    first = trace["Y000"].index(True)
    assert trace["ms"][first] == 3010
    assert max(trace["T0"]) == 30
    slow = plc.trace(["T0"], ms=1000, every=250)
    assert slow["ms"] == [4000, 4250, 4500, 4750, 5000]


def test_moments_power_and_forces():
    plc = rungc.from_list("LD M8000\nINC D0\nINC D512\nEND\n", model="h2u").start()
    plc.scan(5)
    moment = plc.save()
    plc.scan(5)
    assert plc["D0"] == 10
    plc.restore(moment)
    assert (plc["D0"], plc.now_ms) == (5, 50)
    other = rungc.from_list(DELAY).start()
    with pytest.raises(rungc.Error, match="another program"):
        other.restore(moment)
    plc.force("D0", 3)
    plc.scan()
    assert plc["D0"] == 3
    plc.release("D0")
    plc.power_cycle()
    assert (plc["D0"], plc["D512"]) == (0, 6)
    plc.running = False
    plc.scan(3)
    assert not plc.running and plc["D512"] == 6


def test_output_is_text_by_path_and_the_same_each_time():
    project = rungc.open(EXAMPLES / "motor.il")
    program = project.compile()
    assert program.emit_c() == project.compile().emit_c()
    assert "Makefile" in program.emit_c() and "src/lib.rs" in program.emit_rust()
    assert project._repr_svg_().startswith("<svg")
    assert "Y000" in project.ladder()
    assert project.comments == {} or all(project.comments.values())


def test_other_threads_run_meanwhile():
    plc = rungc.open(EXAMPLES / "packer.il").start()
    counted, done = 0, threading.Event()

    def run():
        plc.scan(300_000)
        done.set()

    thread = threading.Thread(target=run)
    thread.start()
    while not done.is_set():
        counted += 1
        time.sleep(0.001)
    thread.join()
    assert counted > 5


def test_the_plugin_shows_what_a_failed_test_used(pytester):
    program = EXAMPLES / "motor.il"
    pytester.makepyfile(
        f"""
        import pytest

        @pytest.mark.rungc({str(program)!r})
        def test_fails(plc):
            plc["X000"] = True
            plc.run(ms=4000)
            assert not plc["Y000"]

        @pytest.mark.rungc({str(program)!r}, model="fx2n")
        def test_passes(plc):
            assert plc["Y000"] is False

        def test_without_a_program(plc):
            pass
        """
    )
    result = pytester.runpytest()
    result.assert_outcomes(passed=1, failed=1, errors=1)
    result.stdout.fnmatch_lines(["*devices of the PLC*", "*0 ms  X000 = 1*", "*4000 ms  Y000 = 1*"])
    result.stdout.fnmatch_lines(["*name the program*"])


#: Both contactors of a motor, with and without an interlock.
BOTH = "LD X000\nOUT Y000\nLD X001\nOUT Y001\nEND\n"
ONE = "LD X000\nOUT Y000\nLD X001\nANI Y000\nOUT Y001\nEND\n"


def test_properties_are_proved_or_come_with_a_run():
    (proved,) = rungc.from_list(ONE).prove("never Y000 & Y001")
    assert proved and proved.verdict == "proved" and proved.run == []
    assert any("200 ms" in one for one in proved.assumptions)
    violated, reached = rungc.from_list(BOTH).prove("never Y000 & Y001", "reachable Y001", scan_ms=50)
    assert not violated and reached
    (scan,) = violated.run
    assert scan["set"] == {"X000": 1, "X001": 1} and scan["after"] == {"Y000": 1, "Y001": 1}
    assert "X000 = 1, X001 = 1" in str(violated)
    (late,) = rungc.from_list(DELAY).prove("whenever X000 then Y000 within 1s")
    assert late.verdict == "violated"
    always_late = "LD M8000\nOUT T0 K20\nLD T0\nOUT Y000\nLD X000\nOUT Y001\nEND\n"
    (vacuous,) = rungc.from_list(always_late).prove("never Y001 & !X000", assume=["!Y000"])
    assert vacuous.verdict == "vacuous" and not vacuous


def test_a_run_that_was_found_happens():
    project = rungc.from_list(BOTH)
    (violated,) = project.prove("never Y000 & Y001")
    plc = project.start()
    for part in violated.run:
        for name, value in part["set"].items():
            plc[name] = value == 1
        plc.scan(part["scans"])
    assert plc["Y000"] and plc["Y001"]


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("Y000", "a property is"),
        ("never Y000 &", "\\^"),
        ("never Y777", "Y777 does not exist"),
        ("whenever X000 then Y000 within soon", "soon"),
        ("never X000 & !X000", "can never hold"),
    ],
)
def test_properties_that_cannot_be_read_say_why(text, why):
    with pytest.raises(rungc.Error, match=why):
        rungc.from_list(ONE).prove(text)


def test_questions_without_sense_raise():
    project = rungc.from_list(ONE)
    with pytest.raises(rungc.Error, match="no property"):
        project.prove()
    with pytest.raises(rungc.Error, match="32767 ms"):
        project.prove("never Y000", scan_ms=0)
    with pytest.raises(rungc.DeviceError):
        project.prove("never Y000", free=["Q5"])
    with pytest.raises(rungc.Rejected):
        rungc.from_list("OTU Y000\nEND\n").prove("never Y000")
    with pytest.raises(rungc.Error, match="different models"):
        project.same_as(rungc.from_list(ONE, model="fx1s"))


def test_outputs_are_compared_with_an_older_program():
    outputs = rungc.from_list(ONE).same_as(rungc.from_list(BOTH))
    assert {name: output.verdict for name, output in outputs.items()} == {"Y000": "same", "Y001": "differs"}
    assert outputs["Y000"] and not outputs["Y001"]
    assert outputs["Y001"].reason == "it differs after 1 scan"


def test_devices_say_why_they_are_off():
    project = rungc.from_list(DELAY)
    assert "T0" in project.why("Y000")
    plc = project.start()
    plc["X000"] = True
    plc.run(ms=1000)
    assert "T0" in plc.why("Y000")
    with pytest.raises(rungc.DeviceError):
        plc.why("Y001")
