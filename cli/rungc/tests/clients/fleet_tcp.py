"""Polls the PLCs of `rungc fleet` with pymodbus: python3 fleet_tcp.py PORT,... UNITS_PORT UNITS.

Each program adds 1 to D0 in D1, and shows M0 at M1. PORT,... are the ports of a PLC each; behind UNITS_PORT are several, by unit.
"""

import sys
import time

from pymodbus.client import ModbusTcpClient


def values(reply):
    assert not reply.isError(), reply
    return reply


def soon(read, wanted):
    """The program needs a scan to see what was written."""
    for _ in range(30_000):
        if read() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{read()} is not {wanted}")


def connect(port):
    client = ModbusTcpClient("127.0.0.1", port=int(port), timeout=300)
    assert client.connect(), port
    return client


ports = [connect(port) for port in sys.argv[1].split(",")]
gateway, units = connect(sys.argv[2]), int(sys.argv[3])
plcs = [(client, 1) for client in ports] + [(gateway, unit) for unit in range(1, units + 1)]

for n, (client, unit) in enumerate(plcs):
    values(client.write_register(0, n, device_id=unit))
    values(client.write_coil(0, n % 3 == 0, device_id=unit))
# Nobody got what was another's.
for n, (client, unit) in enumerate(plcs):
    soon(lambda: values(client.read_holding_registers(0, count=2, device_id=unit)).registers, [n, n + 1])
    soon(lambda: values(client.read_coils(0, count=2, device_id=unit)).bits[:2], [n % 3 == 0] * 2)

reply = gateway.read_holding_registers(0, count=1, device_id=units + 1)
assert reply.isError() and reply.exception_code == 10, reply
reply = ports[0].read_holding_registers(0, count=1, device_id=9)
assert reply.isError() and reply.exception_code == 10, reply
# What emitted C does not store is rejected.
reply = ports[-1].read_holding_registers(700, count=1)
assert reply.isError() and reply.exception_code == 2, reply
print(f"{len(plcs)} PLCs")
