"""A Modbus TCP server of pymodbus that a program asks: python3 modbus_server.py PORT SERVER.

PORT is that of `--modbus-tcp`, by which the program's devices are looked at and written; at SERVER the server listens. The program reads the
registers 500 and 501 of the server to D205, and the coils 20 to 39 to D240 while M12 is on; while M10 is on, it writes D220 and D221 to
address 600, while M11 is on D230 to coil 10, while M13 is on D245 to the coils 40 to 49; while M14 is on, it reads a register that the server
does not have.
"""

import asyncio
import sys
import threading
import time

from pymodbus.client import ModbusTcpClient
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

port, own = (int(number) for number in sys.argv[1:3])


class Server:
    """A server that can go away."""

    def __init__(self):
        self.ready, self.over = threading.Event(), threading.Event()
        self.thread = threading.Thread(target=lambda: asyncio.run(self.serve()), daemon=True)
        self.thread.start()
        assert self.ready.wait(20)

    async def serve(self):
        self.loop, self.end = asyncio.get_running_loop(), asyncio.Event()
        bits = [SimData(0, count=10, values=[False] * 16, datatype=DataType.BITS)]
        words = [SimData(0, count=1000, datatype=DataType.REGISTERS)]
        device = SimDevice(1, (bits, bits, words, words))
        self.server = ModbusTcpServer(device, address=("127.0.0.1", own))
        await self.server.serve_forever(background=True)
        self.ready.set()
        await self.end.wait()
        await self.server.shutdown()

    def close(self):
        self.loop.call_soon_threadsafe(self.end.set)
        self.thread.join(20)

    def do(self, action):
        return asyncio.run_coroutine_threadsafe(action, self.loop).result(20)

    def read(self, function, address, count):
        return self.do(self.server.async_getValues(1, function, address, count))

    def write(self, function, address, values):
        self.do(self.server.async_setValues(1, function, address, values))


def soon(look, wanted, seconds=300):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if look() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{look()} is not {wanted}")


plc = ModbusTcpClient("127.0.0.1", port=port, timeout=300)
soon(plc.connect, True)


def drive(number, on):
    assert not plc.write_coil(number, on).isError()


def words(number, count=1):
    return plc.read_holding_registers(number, count=count).registers


# There is no server yet: 84xx, and the last part of its address.
soon(lambda: words(8063), [0x8401])
server = Server()
server.write(16, 500, [11, 22])
soon(lambda: words(205, 2), [11, 22])

plc.write_registers(220, [1234, 5678])
drive(10, True)
soon(lambda: server.read(3, 600, 2), [1234, 5678])
drive(10, False)

plc.write_register(230, 1)
drive(11, True)
soon(lambda: server.read(1, 10, 1), [True])
plc.write_register(230, 0)
soon(lambda: server.read(1, 10, 1), [False])
drive(11, False)

plc.write_register(245, 0x155)
drive(13, True)
soon(lambda: server.read(1, 40, 10), [True, False] * 5)
drive(13, False)
server.write(15, 20, [True, False, True, True] * 5)
drive(12, True)
soon(lambda: words(240, 2), [0xDDDD, 0xD])
drive(12, False)

# A register that there is not: 83xx. The other requests continue.
drive(14, True)
soon(lambda: words(8063), [0x8301])
server.write(16, 500, [33, 44])
soon(lambda: words(205, 2), [33, 44])
drive(14, False)

# The server goes away, and comes back.
server.close()
soon(lambda: words(8063), [0x8401])
assert words(205, 2) == [33, 44]
server = Server()
server.write(16, 500, [55, 66])
soon(lambda: words(205, 2), [55, 66])
print("all requests are right")
