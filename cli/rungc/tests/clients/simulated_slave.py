"""A Modbus TCP slave of pymodbus with devices at the addresses of FX3U, until its standard input ends. Prints its port."""

import asyncio
import socket
import sys
import threading

from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    port = free.getsockname()[1]


async def serve():
    coils = [SimData(0, count=0x400, values=[False] * 16, datatype=DataType.BITS)]
    inputs = [SimData(0, count=0x400, values=[False] * 16, datatype=DataType.BITS)]
    words = [SimData(0, count=0xA500, datatype=DataType.REGISTERS)]
    device = SimDevice(1, (coils, inputs, words, words))
    server = ModbusTcpServer(device, address=("127.0.0.1", port))
    await server.serve_forever(background=True)
    # M3, X020, T4 and its value, D0 and D1, C200.
    await server.async_setValues(1, 15, 3, [True])
    await server.async_setValues(1, 2, 0x3400 + 0o20, [True])
    await server.async_setValues(1, 15, 0x3000 + 4, [True])
    await server.async_setValues(1, 16, 0xA140 + 4, [12])
    await server.async_setValues(1, 16, 0, [7, 65535])
    await server.async_setValues(1, 16, 0xA408, [0xEE90, 0xFFFE])
    print(port, flush=True)
    await asyncio.Event().wait()


threading.Thread(target=lambda: asyncio.run(serve()), daemon=True).start()
sys.stdin.read()
