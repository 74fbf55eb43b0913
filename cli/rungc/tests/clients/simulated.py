"""A microcontroller with an Arm core, executed by unicorn: what the models of chips beside this file share.

A chip gives the registers (`read`, `write`), its memory, and how it starts. Here are the ELF file, interrupts, time, pins that
are watched, UARTs, and flash whose operations are noted, so that the supply can be cut after each of them.
"""

import json
import struct
import sys

from elftools.elf.elffile import ELFFile
from unicorn import UC_ARCH_ARM, UC_HOOK_MEM_READ, UC_HOOK_MEM_WRITE, UC_MODE_MCLASS, UC_MODE_THUMB, Uc, UcError
from unicorn.arm_const import (UC_ARM_REG_LR, UC_ARM_REG_PC, UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2,
                               UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_SP, UC_ARM_REG_XPSR)

CALLED = (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_LR, UC_ARM_REG_PC,
          UC_ARM_REG_XPSR)
RETURN = 0x0F00_0000
WFI = b"\x30\xbf"


class Line:
    """A UART: what it has sent and what waits in it. The last bit is out a millisecond after the last byte."""

    def __init__(self, interrupt):
        self.interrupt = interrupt
        self.sent = bytearray()
        self.received = bytearray()
        self.busy = False


class Simulated:
    def __init__(self, path, cpu, memory, registers, lines):
        self.uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(cpu)
        self.registers = {}
        self.lines = {at: Line(number) for at, number in lines}
        self.driven = set()
        self.low = set()
        self.analog = {}
        self.watched = {}
        self.events = []
        self.journal = []
        self.fed = 0
        for at, length in [(RETURN, 0x1000)] + memory + registers:
            self.uc.mem_map(at, length)
        with open(path, "rb") as file:
            elf = ELFFile(file)
            parts = [s for s in elf.iter_segments() if s["p_type"] == "PT_LOAD" and s["p_filesz"]]
            self.code = min(part["p_paddr"] for part in parts)
            self.end = max(part["p_paddr"] + part["p_filesz"] for part in parts)
            for part in parts:
                self.uc.mem_write(part["p_paddr"], part.data())
            symbols = elf.get_section_by_name(".symtab")
            self.main = symbols.get_symbol_by_name("main")[0]
        for first, length in registers:
            self.uc.hook_add(UC_HOOK_MEM_READ, self.on_read, begin=first, end=first + length - 1)
            self.uc.hook_add(UC_HOOK_MEM_WRITE, self.on_write, begin=first, end=first + length - 1)
        body = bytes(self.uc.mem_read(self.main["st_value"] & ~1, self.main["st_size"]))
        at = next(offset for offset in range(0, len(body), 2) if body[offset:offset + 2] == WFI)
        self.wait = (self.main["st_value"] & ~1) + at

    def on_read(self, uc, _access, at, _size, _value, _data):
        uc.mem_write(at & ~3, struct.pack("<I", self.read(at & ~3) & 0xFFFF_FFFF))

    def on_write(self, _uc, _access, at, _size, value, _data):
        if 0xE000_E100 <= at < 0xE000_E140:
            value |= self.registers.get(at, 0)  # NVIC_ISER only sets
        self.write(at, value & 0xFFFF_FFFF)

    def drive(self, pin, high):
        """A pin that is driven, and noted if it is one to watch."""
        (self.driven.add if high else self.driven.discard)(pin)
        if self.watched.get(pin) not in (None, high):
            self.events.append(f"{pin} {'high' if high else 'low'}")
        if pin in self.watched:
            self.watched[pin] = high

    def send(self, at, byte):
        self.lines[at].sent.append(byte)
        self.lines[at].busy = True
        self.events.append(f"{byte:02X}")

    def keep(self, operation, at, data):
        """An operation of flash."""
        self.journal.append((operation, at, bytes(data)))
        self.uc.mem_write(at, bytes(data))

    def run(self, start, until):
        """Executes to an address."""
        self.uc.emu_start(start | 1, until, count=50_000_000)
        assert self.uc.reg_read(UC_ARM_REG_PC) & ~1 == until & ~1, "the image hangs"

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
            for line in self.lines.values():
                if self.is_enabled(line.interrupt) and (line.busy or line.received):
                    line.busy = False
                    self.interrupt(16 + line.interrupt)
            self.run(self.wait + 2, self.wait)

    def is_enabled(self, number):
        return self.registers.get(0xE000_E100 + number // 32 * 4, 0) >> number % 32 & 1

    def exchange(self, at, data, enough=lambda sent: False):
        """Bytes to a UART, and what it answers."""
        line = self.lines[at]
        self.pass_ms(2)  # until the last bit of the answer before is out
        line.sent.clear()
        line.received.extend(data)
        for _ in range(200):
            self.pass_ms(1)
            if enough(line.sent):
                break
        return bytes(line.sent)

    def words(self, at, first, count):
        """Registers D by the programming port of an FX."""
        frame = f"0{0x1000 + 2 * first:04X}{2 * count:02X}".encode() + b"\x03"
        whole = b"\x02" + frame + f"{sum(frame) & 0xFF:02X}".encode()
        answer = self.exchange(at, whole, lambda sent: len(sent) >= 4 * count + 4)
        assert answer[:1] == b"\x02" and len(answer) == 4 * count + 4, answer
        return list(struct.unpack(f"<{count}h", bytes.fromhex(answer[1:1 + 4 * count].decode())))


def press(machine, pin):
    """A contact closes and opens."""
    for low in ({pin}, set()):
        machine.low = machine.held | low
        machine.pass_ms(25)


def cut_supply(make, request):
    """Counts presses of a key in D200 and D201, which are saved to flash, until a slot has been erased; then starts the image with
    flash as it was after each operation since shortly before. Returns what the registers were after each start."""
    at, key = int(request["port"]["at"]), request["key"]
    machine = make()
    machine.low = machine.held = set(request["low"])
    machine.start()
    after = 0
    for _ in range(160):
        press(machine, key)
        # Empty flash is erased, too: the second time is when a slot is full.
        slots = {at // request["slot"] for operation, at, _ in machine.journal if operation == "erase"}
        after += len(slots) > 1
        if after == 3:
            break
    journal = machine.journal
    last = machine.words(at, 200, 2)
    erased = next(n for n, (operation, _, _) in reversed(list(enumerate(journal))) if operation == "erase")
    found = []
    for end in range(max(0, erased - request["before"]), len(journal) + 1):
        again = make()
        for _, place, data in journal[:end]:
            again.uc.mem_write(place, data)
        again.low = again.held = set(request["low"])
        again.start()
        found.append(again.words(at, 200, 2))
    return {"last": last, "found": found, "kinds": [operation for operation, _, _ in journal]}


def serve(make):
    """Carries out the requests of a command line; prints what is found."""
    requests = json.loads(sys.argv[-1])
    if "key" in requests:
        print(json.dumps(cut_supply(make, requests)))
        return
    machine = make()
    machine.low = set(requests.get("low", []))
    machine.watched = dict.fromkeys(requests.get("watch", []), False)
    keys, port = requests.get("keys"), requests.get("port")
    line = machine.lines[int(port["at"])] if port else None
    machine.start()
    found = {"modes": machine.modes(), "begin": sorted(machine.driven), "outputs": [], "said": [], "words": [], "events": []}
    machine.events.clear()
    for number, group in enumerate(requests["inputs"]):
        machine.low = set(group)
        analog = requests.get("analog", [])
        machine.analog = analog[number] if number < len(analog) else {}
        if keys:
            line.received.extend(keys[number].encode())
        machine.pass_ms(requests.get("ms", 60))
        found["outputs"].append(sorted(machine.driven))
        found["words"].append([machine.registers.get(int(at), 0) for at in requests.get("registers", [])])
        if keys:
            found["said"].append(line.sent.decode())
            line.sent.clear()
        if "registers" in requests and "read" in requests:
            first, count = requests["read"]
            found["said"].append(machine.words(int(port["at"]), first, count))
        found["events"].append(machine.events[:])
        machine.events.clear()
    if port and "bytes" in port:
        sent = machine.exchange(int(port["at"]), bytes.fromhex(port["bytes"]), len)
        found["sent"] = sent.hex()
    found["fed"] = machine.fed > 0
    print(json.dumps(found))


def guarded(make):
    try:
        serve(make)
    except UcError as error:
        sys.exit(f"unicorn: {error}")
