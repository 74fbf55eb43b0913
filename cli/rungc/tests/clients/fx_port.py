"""Talks to the programming port of an FX3U: python3 fx_port.py LINE, where LINE is a terminal or the TCP port of `rungc run --fx`.

Written from what others have published, without a look at the server: "FX-232AW USER MANUAL"; Xu Yiyi, "Overview of the FX programming port
protocol" (ourDEV.cn, 2009); the drivers KrystianD/fxplc and HslCommunication (FxSerial). It needs nothing but Python.

The program:
    D2 = D0 + D1; Y000 = M0; T0 runs while M1 is on and switches Y001 on after 0.5 s; C0 (of 3) and C200 (of 100000) count M2; S10 follows M3.
"""

import os
import select
import socket
import sys
import time
import tty

ENQ, ACK, NAK, STX, ETX = b"\x05", b"\x06", b"\x15", b"\x02", b"\x03"


class Line:
    """A terminal or a TCP connection, in bytes."""

    def __init__(self, name):
        if name.isdigit():
            self.socket = socket.create_connection(("127.0.0.1", int(name)))
            self.number = self.socket.fileno()
        else:
            self.number = os.open(name, os.O_RDWR | os.O_NOCTTY)
            tty.setraw(self.number)

    def send(self, data):
        while data:
            data = data[os.write(self.number, data):]

    def receive(self, wait):
        ready, _, _ = select.select([self.number], [], [], wait)
        return os.read(self.number, 4096) if ready else b""


line = Line(sys.argv[1])


def total(data):
    return b"%02X" % (sum(data) & 0xFF)


def complete(answer):
    if answer[:1] == STX:
        return len(answer) >= 4 and answer[-3:-2] == ETX
    return len(answer) == 1


def ask(request, wait=300.0):
    """Sends bytes and returns the whole answer, or what came of it."""
    line.send(request)
    answer = b""
    until = time.monotonic() + wait
    while not complete(answer) and time.monotonic() < until:
        answer += line.receive(until - time.monotonic())
    return answer


def frame(text):
    return STX + text + ETX + total(text + ETX)


def command(text):
    """The data of an answer; b"" for ACK, None for NAK."""
    answer = ask(frame(text))
    if answer == ACK:
        return b""
    if answer == NAK:
        return None
    assert answer[:1] == STX and total(answer[1:-2]) == answer[-2:], (text, answer)
    return bytes.fromhex(answer[1:-3].decode())


def read(address, count, extended=False):
    return command((b"E00" if extended else b"0") + b"%04X%02X" % (address, count))


def write(address, data, extended=False):
    return command((b"E10" if extended else b"1") + b"%04X%02X" % (address, len(data)) + data.hex().upper().encode())


def force(number, on, extended=False):
    """The number of a bit stands with its low byte first."""
    code = b"7" if on else b"8"
    return command((b"E" if extended else b"") + code + b"%02X%02X" % (number & 0xFF, number >> 8))


def words(data):
    return [data[n] | data[n + 1] << 8 for n in range(0, len(data), 2)]


def little(value, size=2):
    return value.to_bytes(size, "little")


def soon(look, wanted):
    for _ in range(30_000):
        if look() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{look()} is not {wanted}")


# Where devices are: bytes of images and values, numbers of bits that are forced.
S, X, Y, TIMER, M, COUNTER, M8000 = 0x0000, 0x0080, 0x00A0, 0x00C0, 0x0100, 0x01C0, 0x01E0
T_VALUE, C_VALUE, C200_VALUE, D8000, D = 0x0800, 0x0A00, 0x0C00, 0x0E00, 0x1000
FORCE_S, FORCE_Y, FORCE_M, FORCE_M8000 = 0x0000, 0x0500, 0x0800, 0x0F00
# The same in the address space of FX3, for E commands.
X_D, X_T, X_D8000, X_M, X_M8000, X_Y, X_S = 0x4000, 0x1000, 0x8000, 0x8800, 0x8C00, 0x8BC0, 0x8CE0
# A forced bit of an extended command has the number that its byte and bit have, of 16 bits.
X_FORCE_M, X_FORCE_Y = 0x4000, 0x5E00


def bit(image, number):
    return read(image + number // 8, 1)[0] >> (number % 8) & 1


# Somebody is there, and it is an FX3U.
assert ask(ENQ) == ACK
kind, = words(read(D8000 + 2, 2))
assert kind // 1000 == 24, kind

# Words: the program adds.
assert write(D, little(5) + little(7)) == b""
soon(lambda: words(read(D, 6)), [5, 7, 12])
assert write(D + 2 * 511, little(0xABCD)) == b""
assert words(read(D + 2 * 511, 2)) == [0xABCD]
assert write(D + 2 * 100, bytes(range(64))) == b""
assert read(D + 2 * 100, 64) == bytes(range(64))
assert read(D + 201, 3) == bytes([1, 2, 3]), "a byte that does not begin a word"

# Bits, forced and as images.
assert force(FORCE_M + 0, True) == b""
soon(lambda: bit(Y, 0), 1)
assert bit(M, 0) == 1
assert force(FORCE_M + 0, False) == b""
soon(lambda: bit(Y, 0), 0)
assert force(FORCE_M + 3, True) == b""
soon(lambda: bit(S, 10), 1)
assert force(FORCE_S + 20, True) == b"" and bit(S, 20) == 1
assert force(FORCE_M + 1023, True) == b"" and bit(M, 1023) == 1
assert read(X, 2) == b"\0\0"
assert write(M + 4, b"\xa5") == b"" and read(M + 4, 1) == b"\xa5"
assert [bit(M, n) for n in range(32, 40)] == [1, 0, 1, 0, 0, 1, 0, 1]

# A timer and two counters: contacts and values.
assert force(FORCE_M + 1, True) == b""
soon(lambda: bit(TIMER, 0), 1)
assert words(read(T_VALUE, 2)) == [5]
soon(lambda: bit(Y, 1), 1)
for count in (1, 2, 3):
    force(FORCE_M + 2, True)
    soon(lambda: words(read(C_VALUE, 2)), [count])
    force(FORCE_M + 2, False)
    # A scan takes notice.
    assert write(D, little(count) + little(count)) == b""
    soon(lambda: words(read(D + 4, 2)), [2 * count])
assert write(D, little(5) + little(7)) == b""
soon(lambda: words(read(D, 6)), [5, 7, 12])
assert bit(COUNTER, 0) == 1
assert int.from_bytes(read(C200_VALUE, 4), "little") == 3
assert write(C200_VALUE, little(70000, 4)) == b""
assert int.from_bytes(read(C200_VALUE, 4), "little") == 70000

# Special devices.
assert read(M8000, 1)[0] & 0b1011 == 0b1001, "M8000 and M8003 are on, M8001 is off"
assert words(read(D8000, 2))[0] > 0, "the watchdog's time"

# The same devices by the commands of FX3.
assert words(read(X_D, 6, True)) == [5, 7, 12]
assert write(X_D + 2 * 7000, little(0x1234), True) == b""
assert words(read(X_D + 2 * 7000, 2, True)) == [0x1234]
assert words(read(X_D8000 + 2, 2, True)) == [kind]
assert words(read(X_T, 2, True)) == [5]
assert read(X_M + 4, 1, True) == b"\xa5"
assert read(X_M8000, 1, True)[0] & 0b1011 == 0b1001
assert read(X_S + 1, 1, True)[0] >> 2 & 1 == 1
assert force(X_FORCE_M + 0, True, True) == b""
soon(lambda: read(X_Y, 1, True)[0] & 1, 1)
assert force(X_FORCE_M + 0, False, True) == b""
soon(lambda: read(X_Y, 1, True)[0] & 1, 0)
assert force(X_FORCE_Y + 2, True, True) == b""

# STOP and RUN by the relays that force them.
assert force(FORCE_M8000 + 37, True) == b""
soon(lambda: read(M8000, 1)[0] & 0b1011, 0b1010)
assert force(FORCE_M8000 + 37, False) == b""
soon(lambda: read(M8000, 1)[0] & 0b1011, 0b1001)

# What is wrong is refused, and the port goes on. STOP has cleared D0.
assert write(D, little(5)) == b""
before = read(D, 64)
good = b"11000020100"
assert ask(STX + good + ETX + b"00") == NAK, "a wrong sum"
assert command(b"9100002") is None, "no such command"
assert command(b"1100002010") is None, "an odd number of digits"
assert command(b"01000") is None, "no length"
assert command(b"0GGGG02") is None, "no digits"
assert command(b"0" + b"7FFF02") is None, "no device"
assert ask(frame(b"01000")[:5] + frame(b"0100002")) == frame(b"0500"), "a frame that begins anew"
assert ask(b"\xff\x00zz" + frame(b"0100002")) == frame(b"0500"), "noise before a frame"
assert ask(frame(b"0100002")[:6], 0.3) == b""
assert ask(ENQ) == ACK, "ENQ begins anew"
for n in range(1, len(frame(b"0100002"))):
    ask(frame(b"0100002")[:n], 0.0)
    answer = ask(ENQ)
    while answer[-1:] != ACK:
        more = line.receive(300.0)
        assert more, (n, answer)
        answer += more
assert read(D, 64) == before

# A client that wants to be faster asks for it, and takes no for an answer.
assert ask(frame(b"A5")) in (ACK, NAK)
if len(sys.argv) == 2:
    assert ask(ENQ) == ACK
print("all answers are right")
