// Runs an image for an RP2040 (UF2 or ELF) in rp2040js, the emulator of Wokwi, from the second stage of the boot ROM on, and reports what
// its pins and UARTs do. Arguments: the file, and a JSON list of steps: "low", pins that are connected to ground; "adc", the
// counts of the converter's channels; "feed", bytes for UART0 in hexadecimal; "uart1", bytes for UART1; "ms", how long.
// Prints a JSON list, with for each step: "high", the pins that are driven high at its end; "sent" and "uart1", what the UARTs have
// sent; "driver", how GP3 was at the first byte of UART1; "duty" of the PWM pins; "baud" of the UARTs; "resets" by the watchdog.
const { readFileSync } = require('node:fs');
const { RP2040, LogLevel, ConsoleLogger } = require('rp2040js');

const FLASH = 0x10000000;
const SECOND_STAGE = 0x20041f00; // where the boot ROM copies it
const NANOSECONDS = 1e9 / 125e6;
const HIGH = 1;

function load(mcu, file) {
  const view = new DataView(file.buffer, file.byteOffset, file.length);
  if (file.toString('latin1', 1, 4) === 'ELF') {
    const [headers, size, count] = [view.getUint32(28, true), view.getUint16(42, true), view.getUint16(44, true)];
    for (let n = 0; n < count; n++) {
      const [type, offset, , address, length] = [0, 4, 8, 12, 16].map((at) => view.getUint32(headers + n * size + at, true));
      if (type === 1 && length > 0) mcu.flash.set(file.subarray(offset, offset + length), address - FLASH);
    }
    return;
  }
  for (let at = 0; at < file.length; at += 512) {
    const [address, size] = [view.getUint32(at + 12, true), view.getUint32(at + 16, true)];
    mcu.flash.set(file.subarray(at + 32, at + 32 + size), address - FLASH);
  }
}

function checksum(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte << 24;
    for (let bit = 0; bit < 8; bit++) {
      crc = crc < 0 || crc > 0x7fffffff ? (crc << 1) ^ 0x04c11db7 : crc << 1;
      crc >>>= 0;
    }
  }
  return crc;
}

const mcu = new RP2040();
mcu.logger = new ConsoleLogger(LogLevel.Error, false);
load(mcu, readFileSync(process.argv[2]));
const stage = mcu.flash.slice(0, 256);
if (checksum(stage.subarray(0, 252)) !== new DataView(stage.buffer).getUint32(252, true)) {
  throw new Error('the boot ROM would reject the second stage: its checksum is wrong');
}
mcu.sram.set(stage, SECOND_STAGE - 0x20000000);
mcu.core.PC = SECOND_STAGE;
mcu.core.LR = 0;

// The emulator comes without a boot ROM. Its functions for flash are done here: each writes to a register that is nowhere else.
const [TABLE, STUBS, TRAPS] = [0x40, 0x80, 0x40068000];
const FUNCTIONS = ['lookup', 'IF', 'EX', 'RE', 'RP', 'FC'];
let result = 0;
mcu.bootrom[0x14 / 4] = TABLE;
mcu.bootrom[0x18 / 4] = STUBS | 1;
FUNCTIONS.forEach((_, n) => {
  // ldr r3, =TRAPS; str r0, [r3, 4n]; ldr r0, [r3, 40h]; bx lr
  mcu.bootrom.set([((0x6018 | (n << 6)) << 16) | 0x4b01, 0x47706c18, TRAPS], (STUBS + 16 * n) / 4);
});
mcu.peripherals[TRAPS >>> 12] = {
  readUint32: () => result,
  writeUint32Atomic: (offset) => {
    const [first, second, third] = mcu.core.registers;
    const name = FUNCTIONS[offset / 4];
    const letters = String.fromCharCode(second & 0xff, second >>> 8);
    if (name === 'lookup') result = (STUBS + 16 * FUNCTIONS.indexOf(letters)) | 1;
    if (name === 'RE') mcu.flash.fill(0xff, first, first + second);
    if (name === 'RP') for (let n = 0; n < third; n++) mcu.flash[first + n] &= mcu.readUint8(second + n);
  },
};

let resets = 0;
mcu.peripherals[0x40058].onWatchdogTrigger = () => resets++;
const sent = [[], []];
let driver = null;
mcu.uart[0].onByte = (byte) => sent[0].push(byte);
mcu.uart[1].onByte = (byte) => {
  driver ??= mcu.gpio[3].value === HIGH;
  sent[1].push(byte);
};

// How long the pins of analog outputs are high.
const PWM = [16, 18];
const since = {};
const high = {};
for (const pin of PWM) {
  mcu.gpio[pin].addListener((state) => {
    const now = mcu.clock.nanos;
    if (state !== HIGH && since[pin] !== undefined) high[pin] += now - since[pin];
    since[pin] = state === HIGH ? now : undefined;
  });
}

function run(ms) {
  const end = mcu.clock.nanos + ms * 1e6;
  while (mcu.clock.nanos < end) {
    // The emulator's SysTick does not end a wait for interrupts by itself.
    if (mcu.core.waiting && !mcu.core.pendingSystick) {
      mcu.clock.tick(Math.max(1, Math.min(mcu.clock.nanosToNextAlarm, end - mcu.clock.nanos)));
    } else {
      mcu.core.waiting = false;
      mcu.clock.tick(mcu.core.executeInstruction() * NANOSECONDS);
    }
  }
}

const steps = JSON.parse(process.argv[3]).map((step) => {
  for (let pin = 0; pin < 30; pin++) mcu.gpio[pin].setInputValue(!(step.low ?? []).includes(`GP${pin}`));
  (step.adc ?? []).forEach((count, channel) => (mcu.adc.channelValues[channel] = count));
  for (const pin of PWM) high[pin] = 0;
  driver = null;
  const feeds = [step.feed ?? '', step.uart1 ?? ''].map((text) => [...Buffer.from(text, 'hex')]);
  const begin = mcu.clock.nanos;
  // A character each 1.1 ms, as 9600 bit/s has them.
  while (feeds.some((bytes) => bytes.length > 0)) {
    feeds.forEach((bytes, uart) => bytes.length > 0 && mcu.uart[uart].feedByte(bytes.shift()));
    run(1.1);
  }
  run(step.ms ?? 60);
  const length = mcu.clock.nanos - begin;
  const duty = PWM.map((pin) => {
    const last = since[pin] !== undefined ? mcu.clock.nanos - Math.max(since[pin], begin) : 0;
    return Math.round(((high[pin] + last) / length) * 100) / 100;
  });
  const [uart0, uart1] = sent.map((bytes) => Buffer.from(bytes.splice(0)).toString('hex'));
  const pins = mcu.gpio.map((gpio, pin) => [gpio.value === HIGH, `GP${pin}`]);
  const driven = pins.filter(([on, name]) => on && !PWM.includes(Number(name.slice(2)))).map(([, name]) => name);
  const baud = mcu.uart.map((uart) => uart.baudRate);
  return { high: driven, sent: uart0, uart1, driver, duty, baud, resets };
});
console.log(JSON.stringify(steps));
