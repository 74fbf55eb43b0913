"""Talks to a Modbus slave of `rungc run --serial` with pymodbus, RTU: python3 modbus_rtu.py LINE.

The program adds D0 and D1 to D2 and shows M0 at Y000. The model is H2U, the station 1.
"""

import sys
import time

from pymodbus import FramerType
from pymodbus.client import ModbusSerialClient

# A loaded machine may deliver a request with a pause in it, which cuts the frame: pymodbus asks again.
client = ModbusSerialClient(sys.argv[1], framer=FramerType.RTU, baudrate=9600, timeout=2, retries=100)
assert client.connect()


def values(reply):
    assert not reply.isError(), reply
    return reply


def refused(reply, code):
    assert reply.isError() and reply.exception_code == code, reply


def soon(read, wanted):
    """The program needs a scan to see what was written."""
    for _ in range(30_000):
        if read() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{read()} is not {wanted}")


values(client.write_registers(0, [5, 7], device_id=1))
soon(lambda: values(client.read_holding_registers(0, count=3, device_id=1)).registers, [5, 7, 12])
values(client.write_register(1, 8, device_id=1))
soon(lambda: values(client.read_input_registers(2, count=1, device_id=1)).registers, [13])
values(client.write_coil(0, True, device_id=1))
soon(lambda: values(client.read_coils(0xFC00, count=1, device_id=1)).bits[0], True)
pattern = [True, False, False, True, True]
values(client.write_coils(100, pattern, device_id=1))
assert values(client.read_coils(100, count=5, device_id=1)).bits[:5] == pattern
assert values(client.read_discrete_inputs(0xF800, count=8, device_id=1)).bits == [False] * 8
refused(client.read_holding_registers(0xE800, count=1, device_id=1), 2)
refused(client.write_coil(0xF800, True, device_id=1), 2)
client.close()
print("all answers are right")
