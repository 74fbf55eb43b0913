"""A Modbus slave of pymodbus with faults, on the line of a master: python3 modbus_slave.py LINE PORT M0 D0 [D8063].

LINE is the terminal of `rungc run --serial`, PORT that of `--modbus-tcp`, by which the program is driven and its registers are looked at; M0, D0
and D8063 are the Modbus addresses of these devices. While M0 is on, the program reads 4 registers from address 100 of station 2 to D10; while
M1 is on, it writes D20 and D21 to address 200.
"""

import asyncio
import sys
import threading
import time

from pymodbus import FramerType
from pymodbus.client import ModbusTcpClient
from pymodbus.server import ModbusSerialServer
from pymodbus.simulator import DataType, SimData, SimDevice

path = sys.argv[1]
port, m0, d0 = (int(number) for number in sys.argv[2:5])
d8063 = int(sys.argv[5]) if len(sys.argv) > 5 else None
station = 2

fault = None
sent = 0


def spoil(sending, data):
    """What reaches the line of an answer."""
    global sent
    if not sending:
        return data
    sent += 1
    return fault(data) if fault else data


def crc(data):
    value = 0xFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xA001 if value & 1 else 0)
    return data + value.to_bytes(2, "little")


def late(data):
    time.sleep(1.2)
    return data


# What is wrong with an answer, and what H2U notes of it for COM1 (h1u-h2u-programming §5.6).
FAULTS = [
    ("silence", lambda data: b"", 6345),
    ("a wrong sum", lambda data: data[:-1] + bytes([data[-1] ^ 1]), 6343),
    ("another station", lambda data: crc(bytes([station + 1]) + data[1:-2]), 6342),
    ("another function", lambda data: crc(data[:1] + b"\x04" + data[2:-2]), 6344),
    ("an exception", lambda data: crc(bytes([station, data[1] | 0x80, 2])), 6342),
    ("a cut frame", lambda data: data[:-3], 6343),
    ("a frame with a byte too many", lambda data: data + b"\0", 6341),
    ("too few registers", lambda data: crc(data[:2] + b"\x02" + data[3:5]), 6341),
    ("noise", lambda data: bytes(range(200, 240)), 6343),
    ("a late answer", late, 6345),
]


async def serve():
    registers = [SimData(0, count=1000, datatype=DataType.REGISTERS)]
    device = SimDevice(station, registers)
    server = ModbusSerialServer(device, framer=FramerType.RTU, port=path, baudrate=9600, trace_packet=spoil)
    slave["server"], slave["loop"] = server, asyncio.get_running_loop()
    await server.serve_forever(background=True)
    ready.set()
    await asyncio.Event().wait()


slave, ready = {}, threading.Event()
threading.Thread(target=lambda: asyncio.run(serve()), daemon=True).start()
assert ready.wait(300)


def slave_has(address, values=None):
    """Registers of the slave; with values, they are written."""
    server = slave["server"]
    if values is None:
        action = server.async_getValues(station, 3, address, 2)
    else:
        action = server.async_setValues(station, 16, address, values)
    return asyncio.run_coroutine_threadsafe(action, slave["loop"]).result(300)


plc = ModbusTcpClient("127.0.0.1", port=port, timeout=300)
assert plc.connect()


def drive(number, on):
    assert not plc.write_coil(m0 + number, on).isError()


def words(number, count):
    return plc.read_holding_registers(d0 + number, count=count).registers


def soon(look, wanted, seconds=300):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if look() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{look()} is not {wanted}")


slave_has(100, [11, 22, 33, 44])
drive(0, True)
soon(lambda: words(10, 4), [11, 22, 33, 44])
drive(0, False)
assert not plc.write_registers(d0 + 20, [1234, 5678]).isError()
drive(1, True)
soon(lambda: slave_has(200), [1234, 5678])
drive(1, False)
time.sleep(0.3)

for number, (name, what, code) in enumerate(FAULTS):
    values = [number + 500] * 4
    slave_has(100, values)
    before, asked = words(10, 4), sent
    fault = what
    drive(0, True)
    # The next request shows that the first answer has been dealt with.
    soon(lambda: sent >= asked + 2, True)
    if what is not late:
        assert words(10, 4) == before, name
    if d8063 is not None:
        # An answer that is late since the machine is busy is asked for again.
        soon(lambda: plc.read_holding_registers(d8063, count=1).registers, [code])
    fault = None
    soon(lambda: words(10, 4), values)
    drive(0, False)
    time.sleep(0.1)
print("all answers are right")
