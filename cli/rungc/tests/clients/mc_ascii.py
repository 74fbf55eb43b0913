"""Talks to `rungc run --mc` in ASCII, with frames 3E of pymcprotocol and 1E of fx3u-mcprotocol: python3 mc_ascii.py PORT.

The program adds D0 and D1 to D2 and shows M0 at Y000. The model is FX3U.
"""

import sys
import time

from fx3u_mcprotocol import FX3UClient
from pymcprotocol import Type3E
from pymcprotocol.mcprotocolerror import MCProtocolError

port = int(sys.argv[1])
plc = Type3E()
plc.setaccessopt(commtype="ascii")
plc.connect("127.0.0.1", port)


def soon(read, wanted):
    """The program needs a scan to see what was written."""
    for _ in range(30_000):
        if read() == wanted:
            return
        time.sleep(0.01)
    raise AssertionError(f"{read()} is not {wanted}")


plc.batchwrite_wordunits("D0", [5, -7])
soon(lambda: plc.batchread_wordunits("D0", 3), [5, -7, -2])
plc.batchwrite_bitunits("M0", [1])
soon(lambda: plc.batchread_bitunits("Y0", 1), [1])
pattern = [1, 0, 1] * 101
plc.batchwrite_bitunits("M100", pattern)
assert plc.batchread_bitunits("M100", 303) == pattern
plc.randomwrite(["D1000", "D1002"], [1000, 2000], ["D1004"], [655362])
assert plc.randomread(["D1000", "D1002"], ["D1004"]) == ([1000, 2000], [655362])
plc.randomwrite_bitunits(["M50", "M52"], [1, 1])
assert plc.batchread_bitunits("M50", 3) == [1, 0, 1]
assert plc.read_cputype()[0].strip() == "RUNGC"
try:
    plc.batchread_wordunits("D9000", 1)
    raise AssertionError("no error")
except MCProtocolError:
    pass
assert plc.batchread_wordunits("D0", 1) == [5]

panel = FX3UClient("127.0.0.1", port)
panel.connect()
assert panel.readRegs("D0", 3) == [5, 0xFFF9, 0xFFFE]
assert panel.readBits("M100", 5) == [True, False, True, True, False]
assert panel.readBit("Y0") is True
assert panel.readReg("D1002") == 2000
panel.close()
plc.close()
print("all answers are right")
