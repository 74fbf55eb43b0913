"""Talks to `rungc run --modbus-tcp` with uModbus: python umodbus_tcp.py PORT.

The program adds D0 and D1 to D2, and M0 switches Y000.
"""

import socket
import sys
import time

from umodbus import conf
from umodbus.client import tcp
from umodbus.exceptions import IllegalDataAddressError

conf.SIGNED_VALUES = True
line = socket.create_connection(("127.0.0.1", int(sys.argv[1])), timeout=300)


def ask(message):
    return tcp.send_message(message, line)


def soon(message, wanted):
    for _ in range(30_000):
        value = ask(message())
        if value == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(value)


ask(tcp.write_multiple_registers(slave_id=1, starting_address=0, values=[20, -22]))
soon(lambda: tcp.read_holding_registers(slave_id=1, starting_address=0, quantity=3), [20, -22, -2])
ask(tcp.write_single_register(slave_id=1, address=1, value=22))
soon(lambda: tcp.read_holding_registers(slave_id=1, starting_address=2, quantity=1), [42])
ask(tcp.write_single_coil(slave_id=1, address=0, value=1))
assert ask(tcp.read_coils(slave_id=1, starting_address=0, quantity=2)) == [1, 0]
ask(tcp.write_multiple_coils(slave_id=1, starting_address=0, values=[0, 1]))
assert ask(tcp.read_coils(slave_id=1, starting_address=0, quantity=2)) == [0, 1]
try:
    ask(tcp.read_holding_registers(slave_id=1, starting_address=60000, quantity=1))
except IllegalDataAddressError:
    print("all answers are right")
else:
    raise AssertionError("there is nothing at address 60000")
