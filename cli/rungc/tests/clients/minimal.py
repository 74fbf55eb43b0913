"""Talks to two Modbus slaves of `rungc run --serial` with minimalmodbus: python3 minimal.py RTU-LINE ASCII-LINE.

The program adds D0 and D1 to D2 and shows M0 at Y000. The model is H2U; station 1 is RTU, station 3 ASCII with 7 data bits and even parity.
"""

import sys
import time

import minimalmodbus


def again(action):
    """A loaded machine may deliver a request with a pause in it, which cuts the frame."""
    for _ in range(100):
        try:
            return action()
        except minimalmodbus.NoResponseError:
            pass
    return action()


def soon(read, wanted):
    for _ in range(30_000):
        if again(read) == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{again(read)} is not {wanted}")


def refused(action, error):
    try:
        again(action)
    except error:
        return
    raise AssertionError("no error")


for path, station, mode in [(sys.argv[1], 1, minimalmodbus.MODE_RTU), (sys.argv[2], 3, minimalmodbus.MODE_ASCII)]:
    plc = minimalmodbus.Instrument(path, station, mode)
    plc.serial.baudrate, plc.serial.timeout = 9600, 2
    again(lambda: plc.write_registers(0, [station, 20]))
    soon(lambda: plc.read_registers(0, 3), [station, 20, station + 20])
    again(lambda: plc.write_register(1, -5, functioncode=6, signed=True))
    soon(lambda: plc.read_register(2, functioncode=4, signed=True), station - 5)
    again(lambda: plc.write_bit(0, 1))
    soon(lambda: plc.read_bit(0xFC00, functioncode=1), 1)
    again(lambda: plc.write_bits(64, [1, 0, 1]))
    assert again(lambda: plc.read_bits(64, 3, functioncode=1)) == [1, 0, 1]
    assert again(lambda: plc.read_bit(0xF800)) == 0
    again(lambda: plc.write_long(300, 123456789, byteorder=minimalmodbus.BYTEORDER_LITTLE_SWAP))
    assert again(lambda: plc.read_long(300, byteorder=minimalmodbus.BYTEORDER_LITTLE_SWAP)) == 123456789
    again(lambda: plc.write_bit(0, 0))
    refused(lambda: plc.read_register(0xE800), minimalmodbus.IllegalRequestError)
    refused(lambda: plc.write_bit(0xF800, 1), minimalmodbus.IllegalRequestError)
    plc.serial.close()
print("all answers are right")
