/* main.c: counts the instructions of the longest call that brings a program's ports up to date, on a Cortex-M4 under QEMU with `-icount
 * shift=0`, where each takes a nanosecond. All characters of a frame have come before the first of these calls. Prints ticks of the core's
 * clock (168 MHz) and how many characters the port has sent. */
#include "board.h"
#include "station.h"
#include "characters.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define SYSTICK_CTRL REGISTER(0xE000E010u)
#define SYSTICK_LOAD REGISTER(0xE000E014u)
#define SYSTICK_VAL REGISTER(0xE000E018u)
#define SYSTICK_MAX 0xFFFFFFu

/* A character at 9600 bit/s, and when the first one is in. */
#define CHARACTER_US 1041u
#define BEGIN_US 60000u

static station_plc plc;
static uint32_t taken, sent;

/* There is no tick. */
void board_tick_handler(uint32_t now_us)
{
    (void)now_us;
}

static void set_line(void *context, uint8_t port, const rungc_line_format *format)
{
    (void)context;
    (void)port;
    (void)format;
}

static bool receive(void *context, uint8_t port, uint32_t now_us, rungc_received *received)
{
    const uint32_t at_us = BEGIN_US + taken * CHARACTER_US;

    (void)context;
    if (port != PORT || taken >= sizeof characters || now_us < at_us) {
        return false;
    }
    *received = (rungc_received){.at_us = at_us, .byte = characters[taken], .fault = RUNGC_CHAR_FAULT_NONE};
    taken++;
    return true;
}

static bool take(void *context, uint8_t port, uint8_t byte, uint32_t now_us)
{
    (void)context;
    (void)port;
    (void)byte;
    (void)now_us;
    sent++;
    return true;
}

static uint16_t unsent(void *context, uint8_t port, uint32_t now_us)
{
    (void)context;
    (void)port;
    (void)now_us;
    return 0;
}

static const rungc_hal hal = {.set_line = set_line, .receive = receive, .send = take, .unsent = unsent};

static void print(uint32_t value)
{
    char text[12];
    char *first = text + sizeof text - 1;

    *first = 0;
    do {
        *--first = (char)('0' + value % 10u);
        value /= 10u;
    } while (value != 0u);
    *--first = ' ';
    board_print(first);
}

int main(void)
{
    uint32_t longest = 0;

    station_init(&plc);
    plc.hal = &hal;
    for (uint32_t now_ms = 0; now_ms < 50u; now_ms += 10u) {
        station_scan(&plc, now_ms, 1000);
    }
    rungc_map map = station_map(&plc);
    const uint32_t before = sent;
    SYSTICK_LOAD = SYSTICK_MAX;
    SYSTICK_CTRL = 5; /* core clock, no interrupt, on */
    for (uint32_t call = 0; call < 10u; call++) {
        SYSTICK_VAL = 0;
        const uint32_t start = SYSTICK_VAL;
        rungc_advance_ports(&map, BEGIN_US + (sizeof characters + 10u + call * 100u) * CHARACTER_US);
        const uint32_t ticks = (start - SYSTICK_VAL) & SYSTICK_MAX;
        longest = ticks > longest ? ticks : longest;
    }
    print(longest);
    print(before);
    print(sent - before);
    board_print("\n");
    board_exit();
}
