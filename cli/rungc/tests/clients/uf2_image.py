"""What uf2utils reads in a UF2 file: the address of the first byte, the families, and the bytes, without gaps."""

import json
import sys

from uf2utils.file import UF2File

blocks = sorted(UF2File(sys.argv[1]), key=lambda block: block.header.address)
origin = blocks[0].header.address
data = bytearray()
for block in blocks:
    assert block.header.address == origin + len(data)
    data += bytes(block.payload)[:block.header.payload_size]
families = sorted({int(block.header.family.id) for block in blocks})
print(json.dumps({"origin": origin, "families": families, "bytes": list(data)}))
