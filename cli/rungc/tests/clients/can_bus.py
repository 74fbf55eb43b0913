"""Talks to `rungc run --can slcan:pty` with python-can: python can_bus.py TERMINAL.

The program answers what it receives under 123h (11 bits, one word) and ABCDEF1h (29 bits, two words) with that plus 1.
"""

import sys
import time

import can

with can.Bus(interface="slcan", channel=sys.argv[1], bitrate=500_000, sleep_after_open=0) as bus:

    def answered(sent, wanted):
        """Whether the frame that is wanted comes while this one is sent again and again."""
        end = time.monotonic() + 300
        while time.monotonic() < end:
            bus.send(sent)
            begin = time.monotonic()
            while time.monotonic() < begin + 0.3:
                came = bus.recv(0.05)
                if came and (came.arbitration_id, came.is_extended_id, bytes(came.data)) == wanted:
                    return True
        return False

    short = can.Message(arbitration_id=0x123, data=[0x12, 0x34], is_extended_id=False)
    assert answered(short, (0x321, False, bytes([0x12, 0x35])))
    # The low word comes first, each with its high byte first.
    long = can.Message(arbitration_id=0x0ABCDEF1, data=[0xFF, 0xFF, 0x00, 0x01, 9, 9, 9, 9], is_extended_id=True)
    assert answered(long, (0x1FFFFFFF, True, bytes([0x00, 0x00, 0x00, 0x02])))
    # What is not for the program changes nothing.
    bus.send(can.Message(arbitration_id=0x124, data=[1] * 8, is_extended_id=False))
    bus.send(can.Message(arbitration_id=0x123, is_remote_frame=True, dlc=2, is_extended_id=False))
    assert answered(short, (0x321, False, bytes([0x12, 0x35])))
print("all frames are right")
