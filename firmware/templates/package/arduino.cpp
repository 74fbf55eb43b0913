#include <PROGRAM_board.h>

// A terminal of the PLC and its pin on the board.
struct Terminal {
    uint16_t number; // 8 is X010 or Y010
    uint8_t pin;
};

// The pins are an example: change them for your board.
static const uint8_t NOT_CONNECTED = 255;

// An input is on while its pin is connected to ground.
static const Terminal inputs[] = {
/* INPUTS */};
static const Terminal outputs[] = {
/* OUTPUTS */};
static const size_t INPUTS = sizeof inputs / sizeof inputs[0];
static const size_t OUTPUTS = sizeof outputs / sizeof outputs[0];

static PROGRAM_plc plc;
static rungc_board board;

static bool read_input(void *, uint16_t number, bool *on)
{
    for (size_t i = 0; i < INPUTS; i++) {
        if (inputs[i].number == number && inputs[i].pin != NOT_CONNECTED) {
            *on = digitalRead(inputs[i].pin) == LOW;
            return true;
        }
    }
    return false;
}

static void write_output(void *, uint16_t number, bool on)
{
    for (size_t i = 0; i < OUTPUTS; i++) {
        if (outputs[i].number == number && outputs[i].pin != NOT_CONNECTED) {
            digitalWrite(outputs[i].pin, on ? HIGH : LOW);
        }
    }
}

static uint32_t now_us(void *)
{
    return micros();
}

/* EDGES */void setup()
{
    for (size_t i = 0; i < INPUTS; i++) {
        if (inputs[i].pin != NOT_CONNECTED) {
            pinMode(inputs[i].pin, INPUT_PULLUP);
        }
    }
    for (size_t i = 0; i < OUTPUTS; i++) {
        if (outputs[i].pin != NOT_CONNECTED) {
            pinMode(outputs[i].pin, OUTPUT);
        }
    }
    board.hal.input = read_input;
    board.hal.set_output = write_output;
    board.now_us = now_us;
    board.period_us = 5000; // a scan every 5 ms
/* ATTACH */    PROGRAM_init(&plc);
}

void loop()
{
    PROGRAM_poll(&plc, &board);
}
