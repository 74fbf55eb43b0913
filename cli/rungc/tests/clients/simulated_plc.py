"""A simulated PLC that speaks MC protocol, frame 3E, until its standard input ends. Prints its port."""

import sys

from virtual_plc.server import Server

server = Server()
memory = server.memory
memory.write_bits("X", 0x10, [1])
memory.write_bits("M", 3, [1])
memory.write_words("D", 0, [7, 65535])
memory.write_words("TN", 4, [12])
server.start()
print(server.address[1], flush=True)
sys.stdin.read()
server.stop()
