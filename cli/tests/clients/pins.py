"""Executes the image of a board with unicorn and a model of registers, and reports what its pins do.

Arguments: the ELF file, the chip (stm32f1, stm32f0), and a JSON object of requests:
  inputs   groups of pins that are low; all other inputs are high. For each group, what the output pins do.
  keys     characters that come in before each group, if the image is one that only tries pins; then "said" is what it
           has sent in each group
  port     the UART and the interrupt of a programming port, the bytes that come in, in hexadecimal.
Prints a JSON object: "outputs", for each group the names of the pins that are driven high; "modes", how each pin is set
up; "sent", what the port has sent; "fed", whether the watchdog was served.

What is driven high is computed from the writes to registers of ports alone, as the reference manuals describe them.
"""

import json
import struct
import sys

from elftools.elf.elffile import ELFFile
from unicorn import UC_ARCH_ARM, UC_HOOK_MEM_READ, UC_HOOK_MEM_WRITE, UC_MODE_MCLASS, UC_MODE_THUMB, Uc, UcError
from unicorn.arm_const import (UC_ARM_REG_LR, UC_ARM_REG_PC, UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2,
                               UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_SP, UC_ARM_REG_XPSR, UC_CPU_ARM_CORTEX_M0,
                               UC_CPU_ARM_CORTEX_M3)

CALLED = (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_LR, UC_ARM_REG_PC,
          UC_ARM_REG_XPSR)
RETURN = 0x0F00_0000
WFI = b"\x30\xbf"


class Ports:
    """GPIO ports of STM32: what is written to them, and what they make of the pins."""

    def __init__(self, chip):
        self.first, self.moder = {"stm32f1": (0x4001_0800, False), "stm32f0": (0x4800_0000, True)}[chip]
        self.count = 7
        self.registers = {}
        self.driven = set()
        self.low = set()

    def has(self, at):
        return self.first <= at < self.first + 0x400 * self.count

    def name(self, port, bit):
        return "P" + "ABCDEFG"[port] + str(bit)

    def read(self, at):
        port, offset = divmod(at - self.first, 0x400)
        if offset == (0x10 if self.moder else 0x08):
            return sum(1 << bit for bit in range(16) if self.name(port, bit) not in self.low)
        reset = 0x4444_4444 if not self.moder and offset in (0, 4) else 0
        return self.registers.get(at, reset)

    def write(self, at, value):
        port, offset = divmod(at - self.first, 0x400)
        if offset == (0x18 if self.moder else 0x10):
            for bit in range(16):
                name = self.name(port, bit)
                if value >> bit & 1:
                    self.driven.add(name)
                elif value >> (bit + 16) & 1:
                    self.driven.discard(name)
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


class Machine:
    def __init__(self, path, chip):
        self.ports = Ports(chip)
        self.uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M3 if chip == "stm32f1" else UC_CPU_ARM_CORTEX_M0)
        self.registers = {}
        self.sent = bytearray()
        self.received = bytearray()
        self.uart = None
        self.state, self.take, self.give = (0x00, 0x04, 0x04) if chip == "stm32f1" else (0x1C, 0x24, 0x28)
        self.fed = 0
        for at, length in [(0, 0x1000), (RETURN, 0x1000), (0x0800_0000, 1 << 20), (0x2000_0000, 1 << 18),
                           (0x4000_0000, 1 << 20), (0x4800_0000, 1 << 16), (0xE000_0000, 1 << 20)]:
            self.uc.mem_map(at, length)
        with open(path, "rb") as file:
            elf = ELFFile(file)
            self.code = next(s for s in elf.iter_segments() if s["p_type"] == "PT_LOAD")["p_paddr"]
            for segment in elf.iter_segments():
                if segment["p_type"] == "PT_LOAD" and segment["p_filesz"]:
                    self.uc.mem_write(segment["p_paddr"], segment.data())
            symbols = elf.get_section_by_name(".symtab")
            self.main = symbols.get_symbol_by_name("main")[0]
        for first, last in [(0x4000_0000, 0x4010_0000), (0x4800_0000, 0x4801_0000), (0xE000_0000, 0xE010_0000)]:
            self.uc.hook_add(UC_HOOK_MEM_READ, self.on_read, begin=first, end=last - 1)
            self.uc.hook_add(UC_HOOK_MEM_WRITE, self.on_write, begin=first, end=last - 1)

    def vector(self, number):
        return struct.unpack("<I", self.uc.mem_read(self.code + 4 * number, 4))[0]

    def on_read(self, uc, _access, at, _size, _value, _data):
        uc.mem_write(at & ~3, struct.pack("<I", self.read(at & ~3)))

    def read(self, at):
        if self.ports.has(at):
            return self.ports.read(at)
        if self.uart and at == self.uart + self.state:
            return 0xC0 | (0x20 if self.received else 0)
        if self.uart and at == self.uart + self.take:
            return self.received.pop(0) if self.received else 0
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
        return value

    def on_write(self, _uc, _access, at, _size, value, _data):
        value &= 0xFFFF_FFFF
        if self.ports.has(at):
            self.ports.write(at, value)
        elif self.uart and at == self.uart + self.give:
            self.sent.append(value & 0xFF)
        elif at == 0x4000_3000:
            self.fed += value == 0xAAAA
        self.registers[at] = value

    def run(self, start, until):
        """Executes to an address; waiting for an interrupt ends it, too."""
        self.uc.emu_start(start | 1, until, count=50_000_000)

    def start(self):
        self.uc.reg_write(UC_ARM_REG_SP, self.vector(0))
        size = self.main["st_size"]
        body = bytes(self.uc.mem_read(self.main["st_value"] & ~1, size))
        at = next(offset for offset in range(0, size, 2) if body[offset:offset + 2] == WFI)
        self.wait = (self.main["st_value"] & ~1) + at
        self.run(self.vector(1), self.wait)

    def interrupt(self, number):
        """Calls a handler as the core does, as far as the handler sees."""
        saved = [self.uc.reg_read(register) for register in CALLED]
        self.uc.reg_write(UC_ARM_REG_LR, RETURN | 1)
        self.run(self.vector(number), RETURN)
        for register, value in zip(CALLED, saved):
            self.uc.reg_write(register, value)

    def pass_ms(self, count):
        for _ in range(count):
            self.interrupt(15)
            self.run(self.wait + 2, self.wait)


def main():
    path, chip, requests = sys.argv[1], sys.argv[2], json.loads(sys.argv[3])
    machine = Machine(path, chip)
    machine.ports.low = set(requests.get("low", []))
    keys = requests.get("keys")
    if keys:
        machine.uart = int(requests["port"]["at"])
    machine.start()
    found = {"modes": machine.ports.modes(), "begin": sorted(machine.ports.driven), "outputs": [], "said": []}
    for number, group in enumerate(requests["inputs"]):
        machine.ports.low = set(group)
        if keys:
            machine.received.extend(keys[number].encode())
        machine.pass_ms(requests.get("ms", 60))
        found["outputs"].append(sorted(machine.ports.driven))
        if keys:
            found["said"].append(machine.sent.decode())
            machine.sent.clear()
    if "port" in requests and not keys:
        port = requests["port"]
        machine.uart = int(port["at"])
        machine.received.extend(bytes.fromhex(port["bytes"]))
        machine.interrupt(16 + port["interrupt"])
        for _ in range(200):
            machine.pass_ms(1)
            machine.interrupt(16 + port["interrupt"])
        found["sent"] = machine.sent.hex()
    found["fed"] = machine.fed > 0
    print(json.dumps(found))


try:
    main()
except UcError as error:
    sys.exit(f"unicorn: {error}")
