"""Executes the image of a board with an RP2040, from the second stage of its boot ROM on, and reports what its pins, converter,
UARTs and flash do. Arguments: the ELF file and a JSON object of requests (stm32.py). Registers follow the data sheet; the functions
of the boot ROM are done here, and flash holds nothing that runs while one of them has it.
"""

import struct
import sys

from simulated import UC_ARM_REG_LR, UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_SP, Simulated, guarded
from unicorn.arm_const import UC_CPU_ARM_CORTEX_M0

FLASH, LENGTH = 0x1000_0000, 2 << 20
SECOND_STAGE = 0x2004_1F00
SIO, IO_BANK0, PADS = 0xD000_0000, 0x4001_4000, 0x4001_C000
UARTS = [(0x4003_4000, 20), (0x4003_8000, 21)]
# Functions of the boot ROM: each writes to a register here, which does its work, and returns what RESULT holds.
TABLE, STUBS, TRAPS, RESULT = 0x40, 0x80, 0x4006_8000, 0x4006_8040
FUNCTIONS = [b"lookup", b"IF", b"EX", b"RE", b"RP", b"FC"]


def checksum(data):
    crc = 0xFFFF_FFFF
    for byte in data:
        crc ^= byte << 24
        for _ in range(8):
            crc = (crc << 1 ^ (0x04C1_1DB7 if crc >> 31 else 0)) & 0xFFFF_FFFF
    return crc


class Rp2040(Simulated):
    def __init__(self, path):
        memory = [(0, 0x4000), (FLASH, LENGTH), (0x2000_0000, 0x4_2000)]
        registers = [(0x1800_0000, 0x1000), (0x4000_0000, 0x7_0000), (SIO, 0x1000), (0xE000_0000, 0x10_0000)]
        super().__init__(path, UC_CPU_ARM_CORTEX_M0, memory, registers, UARTS)
        self.uc.mem_write(self.end, b"\xff" * (FLASH + LENGTH - self.end))
        self.enabled = set()
        self.called = []
        self.hidden = b""
        rom = bytearray(0x4000)
        rom[0x14:0x1C] = struct.pack("<HHHH", TABLE, 0, STUBS | 1, 0)
        for n in range(len(FUNCTIONS)):
            # ldr r3, =TRAPS; str r0, [r3, 4n]; ldr r0, [r3, 40h]; bx lr
            code = struct.pack("<HHHHI", 0x4B01, 0x6018 | n << 6, 0x6C18, 0x4770, TRAPS)
            rom[STUBS + 16 * n:STUBS + 16 * n + 12] = code
        self.uc.mem_write(0, bytes(rom))

    def start(self):
        stage = bytes(self.uc.mem_read(FLASH, 256))
        assert checksum(stage[:252]) == struct.unpack("<I", stage[252:])[0], "the boot ROM would not start this"
        self.uc.mem_write(SECOND_STAGE, stage)
        self.uc.reg_write(UC_ARM_REG_LR, 0)
        self.run(SECOND_STAGE, self.wait)
        assert self.registers[0xE000_ED08] == FLASH + 0x100

    def vector(self, number):
        return struct.unpack("<I", self.uc.mem_read(FLASH + 0x100 + 4 * number, 4))[0]

    def call(self, name):
        uc = self.uc
        first, second, third = (uc.reg_read(n) for n in (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2))
        if name == b"lookup":
            assert first == TABLE
            self.registers[RESULT] = STUBS + 16 * FUNCTIONS.index(struct.pack("<H", second)) | 1
            return
        self.called.append(name)
        if name == b"IF":
            # Until the second stage runs again, an instruction out of flash is an undefined one.
            self.hidden = bytes(uc.mem_read(FLASH, self.end - FLASH))
            uc.mem_write(FLASH, b"\xff\xde" * (len(self.hidden) // 2))
        elif name == b"RE":
            assert self.called[-2:-1] == [b"EX"] and first % 4096 == 0 and second % 4096 == 0
            self.keep("erase", FLASH + first, b"\xff" * second)
        elif name == b"RP":
            assert self.called[-2:-1] == [b"EX"] and first % 256 == 0 and third % 256 == 0
            were, new = uc.mem_read(FLASH + first, third), uc.mem_read(second, third)
            assert all(new == 0xFF or old == 0xFF for old, new in zip(were, new)), "flash that is not erased is written"
            self.keep("write", FLASH + first, bytes(a & b for a, b in zip(were, new)))

    def function(self, pin):
        return self.registers.get(IO_BANK0 + 4 + 8 * pin, 31)

    def mode(self, pin):
        pad = self.registers.get(PADS + 4 + 4 * pin, 0x56)
        if self.function(pin) == 31:
            return "analog" if pad & 0xCC == 0x80 else "nothing"
        if self.function(pin) != 5:
            return f"function {self.function(pin)}"
        return "output" if pin in self.enabled else {0: "input", 8: "pulled up", 4: "pulled down"}[pad & 0xC]

    def modes(self):
        return {f"GP{pin}": self.mode(pin) for pin in range(30)}

    def is_out_of_reset(self, bit):
        return not self.registers.get(0x4000_C000, 0x01FF_FFFF) >> bit & 1

    def read(self, at):
        of = self.registers.get
        base, offset = at & ~0xFFF, at & 0xFFF
        if base in self.lines:
            line = self.lines[base]
            if offset == 0x18:
                return (0 if line.received else 0x10) | (0x08 if line.busy else 0)
            if offset == 0x00:
                return line.received.pop(0) if line.received else 0
        if at == SIO + 4:
            return sum(1 << pin for pin in range(30) if f"GP{pin}" not in self.low)
        if at == 0x4000_C000:
            return of(at, 0x01FF_FFFF)
        if at == 0x4000_C008:
            return ~of(0x4000_C000, 0x01FF_FFFF) & 0x01FF_FFFF
        if at == 0x4002_4004:
            return 0x8000_0000 if of(0x4002_4000, 0) == 0x00FA_BAA0 else 0
        if at in (0x4002_8000, 0x4002_C000):
            return of(at, 1) | (0x8000_0000 if of(at + 8, 0) and not of(at + 4, 0x2D) & 0x21 else 0)
        if at in (0x4002_8004, 0x4002_C004):
            return of(at, 0x2D)
        if at in (0x4000_8038, 0x4000_8044):
            return 1 << (of(at - 8, 0) & 3)
        if at == 0x4004_C000:
            return of(at, 0) & ~4 | (0x100 if of(at, 0) & 1 and self.is_out_of_reset(0) else 0)
        if at == 0x4004_C004:
            pin = 26 + (of(0x4004_C000, 0) >> 12 & 7)
            return self.analog.get(f"GP{pin}", 0) if self.mode(pin) == "analog" else 0
        if at == 0xE000_E010:
            return of(at, 0) | 1 << 16
        return of(at, 0)

    def write(self, at, value):
        base = at & ~0xFFF
        if TRAPS <= at < RESULT:
            self.call(FUNCTIONS[(at - TRAPS) // 4])
            return
        for pin in range(30):
            if value >> pin & 1 and at in (SIO + 0x14, SIO + 0x18):
                self.drive(f"GP{pin}", at == SIO + 0x14)
            elif value >> pin & 1 and at == SIO + 0x24:
                self.enabled.add(pin)
            elif value >> pin & 1 and at == SIO + 0x28:
                self.enabled.discard(pin)
        if base in self.lines and at == base and self.is_out_of_reset(22 if base == 0x4003_4000 else 23):
            self.send(base, value & 0xFF)
        if at == 0x1800_0008 and value == 1:
            assert self.registers.get(0x1800_00F4) == 0x0300_0218
            self.uc.mem_write(FLASH, self.hidden)
            self.hidden = b""
        if at == 0x4005_8004:
            self.fed += value == 4_000_000
        self.registers[at] = value


if __name__ == "__main__":
    guarded(lambda: Rp2040(sys.argv[1]))
