"""Validates an FMU and runs it with FMPy: python fmu.py FILE PLAN. PLAN is JSON: `scan_ms` (or null), `start` and `steps`, each with
its length `h` in seconds and what to `set` before it, and the names to `read` after it. Prints a report as JSON."""

import json
import sys

import fmpy
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

path, plan = sys.argv[1], json.loads(sys.argv[2])
description = fmpy.read_model_description(path)
variables = {variable.name: variable for variable in description.modelVariables}
folder = fmpy.extract(path)
messages = []


def log(_environment, status, category, message):
    messages.append([status, category.decode(), message.decode()])


def instance(name):
    unit = FMU3Slave(
        instanceName=name,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        guid=description.guid,
    )
    unit.instantiate(loggingOn=True, logMessage=log)
    return unit


def begin(unit):
    if plan["scan_ms"] is not None:
        write(unit, "scan_time_ms", plan["scan_ms"])
    unit.enterInitializationMode(startTime=plan["start"])
    unit.exitInitializationMode()


def write(unit, name, value):
    variable = variables[name]
    getattr(unit, "set" + variable.type)([variable.valueReference], [value])


def read(unit, name):
    variable = variables[name]
    return getattr(unit, "get" + variable.type)([variable.valueReference])[0]


def step(unit, time, do, inputs=True):
    for name, value in do["set"].items() if inputs else ():
        write(unit, name, value)
    unit.doStep(time, do["h"])
    return [read(unit, name) for name in plan["read"]]


def refused(call):
    try:
        call()
    except Exception:
        return True
    return False


steps = plan["steps"]
times = [plan["start"] + sum(do["h"] for do in steps[:i]) for i in range(len(steps))]
first, second = instance("first"), instance("second")
begin(first)
begin(second)
rows, quiet = [], []
middle = len(steps) // 2
for i, do in enumerate(steps):
    if i == middle:
        state = first.getFMUState()
        kept = first.serializeFMUState(state)
    rows.append(step(first, times[i], do))
    quiet.append(step(second, times[i], do, inputs=False))

# From the middle on again: in the same instance, and in the other one from bytes.
first.setFMUState(state)
again = [step(first, times[i], steps[i]) for i in range(middle, len(steps))]
copied = second.deserializeFMUState(kept)
second.setFMUState(copied)
other = [step(second, times[i], steps[i]) for i in range(middle, len(steps))]
first.freeFMUState(state)
second.freeFMUState(copied)

# From the start again.
first.reset()
begin(first)
reset = [step(first, times[i], do) for i, do in enumerate(steps)]
end = times[-1] + steps[-1]["h"] - first.getFloat64([0])[0]
refusals = {
    "an output is set": refused(lambda: first.setBoolean([variables[plan["output"]].valueReference], [True])),
    "there is no such variable": refused(lambda: first.getInt16([77])),
    "the scan time is fixed": refused(lambda: write(first, "scan_time_ms", 5)),
    "other functions": refused(lambda: first.getString([1])),
    "bytes of another": refused(lambda: first.deserializeFMUState(kept[:-1])),
    "the time is back": refused(lambda: first.doStep(plan["start"], steps[0]["h"])),
}
first.terminate()
refusals["after the end"] = refused(lambda: first.doStep(times[-1], 1.0))
first.freeInstance()
second.terminate()
second.freeInstance()
print(
    json.dumps(
        {
            "problems": validate_fmu(path),
            "variables": {
                name: [one.type, one.causality, one.valueReference, one.description] for name, one in variables.items()
            },
            "rows": rows,
            "quiet": quiet,
            "again": again == rows[middle:],
            "other": other == rows[middle:],
            "reset": reset == rows,
            "end": end,
            "refusals": refusals,
            "messages": messages,
        }
    )
)
