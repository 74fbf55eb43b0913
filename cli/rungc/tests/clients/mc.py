"""Talks to `rungc run --mc` with pymcprotocol: python3 mc.py PORT.

The program adds D0 and D1 to D2 and shows M0 at Y000. The model is H2U.
"""

import sys
import time

from pymcprotocol import Type3E
from pymcprotocol.mcprotocolerror import MCProtocolError, UnsupportedComandError

plc = Type3E()
plc.connect("127.0.0.1", int(sys.argv[1]))


def soon(read, wanted):
    """The program needs a scan to see what was written."""
    for _ in range(30_000):
        if read() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{read()} is not {wanted}")


def refused(request, error=MCProtocolError):
    try:
        request()
    except error:
        return
    raise AssertionError("no error")


plc.batchwrite_wordunits("D0", [5, 7])
soon(lambda: plc.batchread_wordunits("D0", 3), [5, 7, 12])
plc.batchwrite_bitunits("M0", [1])
soon(lambda: plc.batchread_bitunits("Y0", 1), [1])
pattern = [1, 0, 1] * 100
plc.batchwrite_bitunits("M100", pattern)
assert plc.batchread_bitunits("M100", 300) == pattern
words = plc.batchread_wordunits("M100", 1)
assert words[0] & 0xFFFF == sum(bit << n for n, bit in enumerate(pattern[:16])), words

plc.randomwrite(["D1000", "D1002"], [1000, 2000], ["D1004"], [655362])
assert plc.randomread(["D1000", "D1002"], ["D1004"]) == ([1000, 2000], [655362])
plc.randomwrite_bitunits(["M50", "M52"], [1, 1])
assert plc.batchread_bitunits("M50", 3) == [1, 0, 1]
assert plc.echo_test("ABC") == (3, "ABC")
assert plc.read_cputype()[0].strip() == "RUNGC"

refused(lambda: plc.batchread_wordunits("D9000", 1))
refused(lambda: plc.batchread_wordunits("W0", 1))
refused(lambda: plc.batchwrite_wordunits("D8511", [1, 2]))
refused(plc.remote_latchclear, UnsupportedComandError)
plc.close()
print("all answers are right")
