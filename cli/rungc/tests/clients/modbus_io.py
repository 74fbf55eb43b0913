"""Remote I/O by a server of pymodbus, which is killed and comes back while a program runs: python3 modbus_io.py FOLDER CODE LINE,LINE COMMAND...

COMMAND runs the program of the folder with its rungc.toml; interrupted, it ends with CODE. The server is reached over the two ends of a serial line, the first its own, or over TCP if there are none. With --server and
its place, this is that server: a port, or the end of a line. It takes lines from standard input: `set 2 0 1 0 1` (function, address, values) and `get 1 8 2` (count).
"""

import asyncio
import os
import signal
import socket
import subprocess
import sys
import threading
import time

from pymodbus import FramerType
from pymodbus.client import ModbusTcpClient
from pymodbus.server import ModbusSerialServer, ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

UNIT = 7


async def serve(place):
    def block(kind):
        return [SimData(0, count=64, datatype=kind)]

    blocks = tuple(block(kind) for kind in [DataType.BITS, DataType.BITS, DataType.REGISTERS, DataType.REGISTERS])
    device = SimDevice(UNIT, blocks)
    if place.isdigit():
        server = ModbusTcpServer(device, address=("127.0.0.1", int(place)))
    else:
        server = ModbusSerialServer(device, framer=FramerType.RTU, port=place, baudrate=38400)
    await server.serve_forever(background=True)
    loop = asyncio.get_running_loop()
    print("ready", flush=True)
    while line := await loop.run_in_executor(None, sys.stdin.readline):
        what, *numbers = line.split()
        function, address, *values = map(int, numbers)
        if what == "get":
            values = await server.async_getValues(UNIT, function, address, values[0])
        else:
            if function in (1, 2):
                values = [bool(value) for value in values]
            await server.async_setValues(UNIT, function, address, values)
        print(*map(int, values), flush=True)


if sys.argv[1] == "--server":
    asyncio.run(serve(sys.argv[2]))
    sys.exit()

folder, code, line, *command = sys.argv[1:]
line = line.split(",") if line else []

SETTINGS = """\
[project]
program = "p.il"
model = "h2u"

[serve]
modbus-tcp = 0

[io.valves]
%s
unit = 7
every = "5ms"
timeout = "1s"
fault = "M100"
X000-X007 = "read inputs 0"
X020-X037 = "read input-registers 5"
D100-D103 = "read registers 10"
D110 = "read registers 20 loss -7"
Y000-Y007 = "write coils 8"
Y020-Y037 = "write registers 41"
D200 = "write registers 40"
"""


class Server:
    """The remote station as a process."""

    def __init__(self):
        command = [sys.executable, __file__, "--server", place]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        assert self.process.stdout.readline() == "ready\n"

    def ask(self, *words):
        self.process.stdin.write(" ".join(map(str, words)) + "\n")
        self.process.stdin.flush()
        return [int(word) for word in self.process.stdout.readline().split()]

    def set(self, function, address, *values):
        assert self.ask("set", function, address, *values) == [*values]

    def coils(self):
        return self.ask("get", 1, 8, 8)

    def registers(self):
        return self.ask("get", 3, 40, 2)

    def kill(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()


if line:
    place = line[0]
    connection = f'modbus-rtu = "{line[1]}"\nbaud = 38400\nformat = "8N1"'
else:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        place = str(free.getsockname()[1])
    connection = f'modbus-tcp = "127.0.0.1:{place}"'
with open(os.path.join(folder, "rungc.toml"), "w") as file:
    file.write(SETTINGS % connection)

# The station is not there yet.
pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
run = subprocess.Popen(command, cwd=folder, text=True, **pipes)
said = []
while not (said and "Modbus TCP at" in said[-1]):
    said.append(run.stderr.readline())
    assert said[-1], said
plc = ModbusTcpClient("127.0.0.1", port=int(said[-1].rsplit(":", 1)[1]), timeout=300)
assert plc.connect()
threading.Thread(target=lambda: said.extend(run.stderr), daemon=True).start()


def soon(look, wanted, seconds=300):
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if look() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{look()} is not {wanted}; {said}")


def word(number):
    value = plc.read_holding_registers(number, count=1).registers[0]
    return value - 0x10000 if value & 0x8000 else value


def fault():
    return plc.read_coils(100, count=1).bits[0]


def scans():
    """The program goes on."""
    before = word(0)
    soon(lambda: word(0) != before, True)


def work(server, value):
    """What the station has reaches the program, and what the program makes of it the station."""
    soon(fault, False)
    server.set(2, 0, 1)
    server.set(3, 10, value)
    server.set(3, 20, value + 1)
    server.set(4, 5, 0x1234)
    assert not plc.write_register(11, 0x5678).isError()
    on = [1] + [0] * 7
    soon(server.coils, on)
    soon(server.registers, [value, 0x5678])
    soon(lambda: (word(100), word(110), word(10)), (value, value + 1, 0x1234))


try:
    soon(fault, True)
    soon(lambda: word(110), -7)
    scans()
    server = Server()
    work(server, 321)
    for times in range(3):
        server.kill()
        soon(fault, True)
        # What the connection says, and what a row says.
        soon(lambda: (word(100), word(110), word(10)), (0, -7, 0))
        scans()
        server = Server()
        work(server, 400 + times)
    # An end that is there but silent.
    server.process.send_signal(signal.SIGSTOP)
    soon(fault, True)
    scans()
    server.process.send_signal(signal.SIGCONT)
    work(server, 500)
    # The end of a run leaves the outputs off.
    plc.close()
    run.send_signal(signal.SIGINT)
    assert run.wait(300) == int(code)
    assert server.coils() == [0] * 8
    assert server.registers() == [500, 0]
    server.kill()
finally:
    run.kill()
# On a busy machine also where the station was only late.
changes = ["connected to" in text for text in said if "io valves: " in text]
assert len(changes) >= 10 and changes == [False, True] * (len(changes) // 2), said
print("lost and reached again, each time")
