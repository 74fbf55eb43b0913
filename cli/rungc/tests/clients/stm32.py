"""Executes the image of a board with an STM32, and reports what its pins, converters, UARTs and flash do.

Arguments: the ELF file, the chip (stm32f1, stm32f0), and a JSON object of requests:
  inputs     groups of pins that are low; all other inputs are high. For each group, what the output pins do.
  low        pins that are low from the beginning
  analog     for each group, the counts that the converter finds at pins
  registers  addresses whose last written words are reported for each group
  read       [first, count]: registers D that the programming port reports for each group, if registers are asked for
  watch      pins whose changes are reported, in order with what UARTs send
  keys       characters that come in before each group, if the image is one that only tries pins; then "said" is what it
             has sent in each group
  port       the UART of a programming port, and the bytes that come in, in hexadecimal
  key        instead of groups: the supply is cut after each operation of flash (simulated.py)
Prints a JSON object. What is driven high is computed from the writes to registers alone, as the reference manuals describe them.
"""

import struct
import sys

from simulated import UC_ARM_REG_SP, Simulated, guarded
from unicorn import UC_HOOK_MEM_WRITE
from unicorn.arm_const import UC_CPU_ARM_CORTEX_M0, UC_CPU_ARM_CORTEX_M3

FLASH = 0x0800_0000
CONTROL = 0x4002_2010
LOCK, START, ERASE, PROGRAM = 1 << 7, 1 << 6, 1 << 1, 1
ANALOG = {f"PA{n}": n for n in range(8)} | {"PB0": 8, "PB1": 9} | {f"PC{n}": 10 + n for n in range(6)}


class Ports:
    """GPIO ports: what is written to them, and what they make of the pins."""

    def __init__(self, machine, chip):
        self.machine = machine
        self.first, self.moder = {"stm32f1": (0x4001_0800, False), "stm32f0": (0x4800_0000, True)}[chip]
        self.count = 7
        self.registers = {}

    def has(self, at):
        return self.first <= at < self.first + 0x400 * self.count

    def name(self, port, bit):
        return "P" + "ABCDEFG"[port] + str(bit)

    def read(self, at):
        port, offset = divmod(at - self.first, 0x400)
        if offset == (0x10 if self.moder else 0x08):
            return sum(1 << bit for bit in range(16) if self.name(port, bit) not in self.machine.low)
        reset = 0x4444_4444 if not self.moder and offset in (0, 4) else 0
        return self.registers.get(at, reset)

    def write(self, at, value):
        port, offset = divmod(at - self.first, 0x400)
        if offset == (0x18 if self.moder else 0x10):
            for bit in range(16):
                name = self.name(port, bit)
                if value >> bit & 1:
                    self.machine.drive(name, True)
                elif value >> (bit + 16) & 1:
                    self.machine.drive(name, False)
        self.registers[at] = value

    def mode(self, port, bit):
        base = self.first + 0x400 * port
        if self.moder:
            kind = self.read(base) >> 2 * bit & 3
            function = self.read(base + 0x20 + 4 * (bit // 8)) >> 4 * (bit % 8) & 0xF
            return ["input", "output", f"function {function}", "analog"][kind]
        four = self.read(base + 4 * (bit // 8)) >> 4 * (bit % 8) & 0xF
        return {0: "analog", 2: "output", 4: "input", 8: "pulled", 0xA: "function"}[four]

    def modes(self):
        pins = [(port, bit) for port in range(self.count) for bit in range(16)]
        return {self.name(*pin): self.mode(*pin) for pin in pins}


class Stm32(Simulated):
    def __init__(self, path, chip, page):
        cpu = UC_CPU_ARM_CORTEX_M3 if chip == "stm32f1" else UC_CPU_ARM_CORTEX_M0
        lines = [(0x4001_3800, 37), (0x4000_4C00, 52)] if chip == "stm32f1" else [(0x4001_3800, 27)]
        self.chip, self.page = chip, page
        memory = [(0, 0x1000), (FLASH, 1 << 20), (0x2000_0000, 1 << 18)]
        registers = [(0x4000_0000, 1 << 20), (0x4800_0000, 1 << 16), (0xE000_0000, 1 << 20)]
        super().__init__(path, cpu, memory, registers, lines)
        self.ports = Ports(self, chip)
        self.modes = self.ports.modes
        self.offsets = (0x00, 0x04, 0x04) if chip == "stm32f1" else (0x1C, 0x24, 0x28)
        self.registers[CONTROL] = LOCK
        self.keys = []
        # Flash is erased beyond the image.
        self.uc.mem_write(self.end, b"\xff" * (FLASH + (1 << 20) - self.end))
        self.uc.hook_add(UC_HOOK_MEM_WRITE, self.on_flash, begin=FLASH, end=FLASH + (1 << 20) - 1)

    def vector(self, number):
        return struct.unpack("<I", self.uc.mem_read(self.code + 4 * number, 4))[0]

    def start(self):
        self.uc.reg_write(UC_ARM_REG_SP, self.vector(0))
        self.run(self.vector(1), self.wait)

    def on_flash(self, _uc, _access, at, size, value, _data):
        control = self.registers[CONTROL]
        assert control & (LOCK | PROGRAM) == PROGRAM and size == 2 and at % 2 == 0, "flash is not to be written like that"
        assert bytes(self.uc.mem_read(at, 2)) == b"\xff\xff", "flash that is not erased is written"
        self.keep("write", at, struct.pack("<H", value & 0xFFFF))

    def converted(self, channel):
        """The count of a channel whose pin is connected to the converter."""
        pin = next(pin for pin, number in ANALOG.items() if number == channel)
        port, bit = "ABC".index(pin[1]), int(pin[2:])
        return self.analog.get(pin, 0) if self.ports.mode(port, bit) == "analog" else 0

    def injected(self, base, number):
        """JDR1 to JDR4 of an STM32F1, which convert by themselves (RM0008 §11)."""
        own = {name: self.registers.get(base + at, 0) for name, at in [("cr1", 0x04), ("cr2", 0x08), ("jsqr", 0x38)]}
        clock = self.registers.get(0x4002_1018, 0) >> {0x4001_2400: 9, 0x4001_2800: 10}[base] & 1
        begun = own["cr1"] & 0x500 == 0x500 and own["cr2"] & 0x40_0003 == 0x40_0003
        length = own["jsqr"] >> 20 & 3
        if not (clock and begun) or number > length:
            return 0
        return self.converted(own["jsqr"] >> 5 * (3 - length + number) & 0x1F)

    def read(self, at):
        if self.ports.has(at):
            return self.ports.read(at)
        base, offset = at & ~0x3FF, at & 0x3FF
        if base in self.lines and self.is_uart(base):
            line, (state, take, _) = self.lines[base], self.offsets
            if offset == state:
                return 0x80 | (0 if line.busy else 0x40) | (0x20 if line.received else 0)
            if offset == take:
                return line.received.pop(0) if line.received else 0
        if self.chip == "stm32f1" and base in (0x4001_2400, 0x4001_2800) and 0x3C <= offset <= 0x48:
            return self.injected(base, (offset - 0x3C) // 4)
        value = self.registers.get(at, 0)
        if at == 0xE000_E010:
            return value | 1 << 16  # SysTick has counted
        if at == 0x4002_1000:
            return value | (value & 0x0101_0000) << 1  # oscillators are ready
        if at == 0x4002_1004:
            return value & ~0xC | (value & 3) << 2  # the clock has switched
        if at == 0x4001_2400:
            return 1  # the ADC of an STM32F0 is ready
        if at in (0x4001_2408, 0x4001_2808):
            return value & ~0x8000_000C  # calibration is over
        if at == CONTROL - 4:
            return 0  # flash is never busy
        return value

    def is_uart(self, base):
        enable, bit = (0x4002_1018, 14) if base == 0x4001_3800 else (0x4002_101C, 19)
        return self.registers.get(enable, 0) >> bit & 1

    def write(self, at, value):
        base, offset = at & ~0x3FF, at & 0x3FF
        if self.ports.has(at):
            self.ports.write(at, value)
        elif base in self.lines and self.is_uart(base) and offset == self.offsets[2]:
            self.send(base, value & 0xFF)
        elif at == 0x4000_3000:
            self.fed += value == 0xAAAA
        elif at == CONTROL - 0xC:
            self.keys = self.keys[-1:] + [value]
            if self.keys == [0x4567_0123, 0xCDEF_89AB]:
                self.registers[CONTROL] &= ~LOCK
        if at == CONTROL:
            value |= self.registers[CONTROL] & LOCK
            if value & (LOCK | ERASE | START) == ERASE | START:
                page = self.registers[CONTROL + 4] & ~(self.page - 1)
                self.keep("erase", page, b"\xff" * self.page)
        self.registers[at] = value

    def pass_ms(self, count):
        if self.chip == "stm32f0":
            self.transfer()
        super().pass_ms(count)

    def transfer(self):
        """The DMA controller puts what the ADC of an STM32F0 converts into memory (RM0360 §10, §12)."""
        of = self.registers.get
        begun = of(0x4001_2408, 0) & 5 == 5 and of(0x4001_240C, 0) & 0x2003 == 0x2003 and of(0x4002_0008, 0) & 0xAA1 == 0xAA1
        if begun and of(0x4002_0010) == 0x4001_2440:
            channels = [channel for channel in range(16) if of(0x4001_2428, 0) >> channel & 1]
            for n, channel in enumerate(channels[:of(0x4002_000C, 0)]):
                self.uc.mem_write(of(0x4002_0014) + 4 * n, struct.pack("<I", self.converted(channel)))


if __name__ == "__main__":
    PAGE = 2048 if "--large" in sys.argv else 1024
    guarded(lambda: Stm32(sys.argv[1], sys.argv[2], PAGE))
