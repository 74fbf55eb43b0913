/* pulses.c: counts the instructions of four pulse outputs, on a Cortex-M4 under QEMU with `-icount shift=0`, where each
 * instruction takes a nanosecond. Prints a line for each function: its name, ticks of the core's clock (168 MHz) of the
 * longest call, ticks of all calls, calls. */
#include "board.h"
#include "pulses.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define SYSTICK_CTRL REGISTER(0xE000E010u)
#define SYSTICK_LOAD REGISTER(0xE000E014u)
#define SYSTICK_VAL REGISTER(0xE000E018u)
#define SYSTICK_MAX 0xFFFFFFu

static pulses_plc plc;

/* There is no tick. */
void board_tick_handler(uint32_t now_us)
{
    (void)now_us;
}

static void set_output(void *context, uint16_t number, bool on)
{
    (void)context;
    (void)number;
    (void)on;
}

static void print_number(uint32_t number)
{
    char text[12];
    unsigned at = sizeof text - 1u;
    text[at] = 0;
    do {
        text[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number != 0);
    board_print(" ");
    board_print(text + at);
}

struct count {
    const char *name;
    uint32_t most, all, calls;
};

static uint32_t begin;

static void start(void)
{
    begin = SYSTICK_VAL;
}

static void stop(struct count *count)
{
    const uint32_t ticks = (begin - SYSTICK_VAL) & SYSTICK_MAX;
    count->all += ticks;
    count->calls++;
    count->most = ticks > count->most ? ticks : count->most;
}

int main(void)
{
    static const rungc_hal hal = {.set_output = set_output};
    struct count tick = {.name = "tick"}, edge = {.name = "edge"};
    pulses_init(&plc);
    plc.hal = &hal;
    plc.X0 = 1;
    SYSTICK_LOAD = SYSTICK_MAX;
    SYSTICK_VAL = 0;
    SYSTICK_CTRL = 5; /* core clock, no interrupt, on */
    for (uint32_t now_ms = 0; now_ms < MILLISECONDS; now_ms++) {
        start();
        pulses_tick(&plc, now_ms);
        stop(&tick);
        pulses_scan(&plc, now_ms, 1000);
        const uint32_t end_us = 1000u * (now_ms + 1u);
        uint32_t now_us = 1000u * now_ms;
        while (now_us < end_us) {
            start();
            const uint32_t wait = pulses_pulse_timer(&plc, now_us);
            stop(&edge);
            if (wait > end_us - now_us) {
                break;
            }
            now_us += wait;
        }
    }
    const struct count *counts[] = {&tick, &edge};
    for (unsigned n = 0; n < 2u; n++) {
        board_print(counts[n]->name);
        print_number(counts[n]->most);
        print_number(counts[n]->all);
        print_number(counts[n]->calls);
        board_print("\n");
    }
    board_exit();
}
