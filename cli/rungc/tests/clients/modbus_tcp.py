"""Talks to `rungc run --modbus-tcp` with pymodbus: python3 modbus_tcp.py PORT.

The program adds D0 and D1 to D2 and shows M0 at Y000. The model is H2U.
"""

import sys
import time

from pymodbus.client import ModbusTcpClient

client = ModbusTcpClient("127.0.0.1", port=int(sys.argv[1]), timeout=300)
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


values(client.write_registers(0, [5, 7]))
soon(lambda: client.read_holding_registers(0, count=3).registers, [5, 7, 12])
values(client.write_register(1, 0xFFFF))
soon(lambda: client.read_input_registers(2, count=1).registers, [4])

values(client.write_coil(0, True))
soon(lambda: client.read_coils(0xFC00, count=1).bits[0], True)
pattern = [True, False, True] * 100
values(client.write_coils(100, pattern))
assert values(client.read_coils(100, count=300)).bits[:300] == pattern
assert values(client.read_discrete_inputs(0xF800, count=8)).bits == [False] * 8

# 32-bit counters take two registers; C200 is at F700h.
values(client.write_registers(0xF700, [0x5678, 0x1234]))
assert values(client.read_holding_registers(0xF700, count=2)).registers == [0x5678, 0x1234]

for unit in (0, 255):
    assert values(client.read_holding_registers(0, count=1, device_id=unit)).registers == [5]
refused(client.read_holding_registers(0, count=1, device_id=9), 10)
refused(client.read_holding_registers(0xF805, count=1), 2)
refused(client.write_coil(0xF800, True), 2)
refused(client.write_registers(0x203F, [1, 2]), 2)
refused(client.readwrite_registers(read_address=0, read_count=1, write_address=0, values=[1]), 1)

# Many clients, and one that says half a request.
others = [ModbusTcpClient("127.0.0.1", port=int(sys.argv[1]), timeout=300) for _ in range(10)]
for other in others:
    assert other.connect()
    other.socket.send(bytes([0, 1, 0, 0, 0]))
assert values(client.read_holding_registers(0, count=125)).registers[0] == 5
for other in others:
    other.close()
client.close()
print("all answers are right")
