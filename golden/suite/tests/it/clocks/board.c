#include "test_board.h"
#include <stdio.h>

static uint32_t now, behind;

static uint32_t now_us(void *context)
{
    (void)context;
    return now - behind;
}

static bool input(void *context, uint16_t number, bool *on)
{
    (void)context;
    *on = number == 0u;
    return true;
}

static void run(uint32_t begin, uint32_t misread)
{
    test_plc plc;
    rungc_board board = {.hal = {.input = input}, .now_us = now_us, .period_us = 5000u};
    uint32_t done = 0, changes[100];
    unsigned count = 0;
    bool on = false;

    test_init(&plc);
    for (uint32_t poll = 0; poll < 24000u; poll++) {
        now = begin + 500u * poll;
        behind = poll % 100u == 51u ? misread : 0u;
        test_poll(&plc, &board);
        const uint32_t units = (poll + 5u) / 100u;
        if (done == 0u && test_output(&plc, 0)) {
            done = units;
        }
        if (test_output(&plc, 1) != on && count < 100u) {
            on = !on;
            changes[count++] = units;
        }
    }
    printf("%lu:", (unsigned long)done);
    for (unsigned i = 0; i < count; i++) {
        printf(" %lu", (unsigned long)changes[i]);
    }
    printf("; %d %d\n", plc.D0, (plc.D1 + 3) / 10);
}

int main(void)
{
    static const uint32_t begins[] = BEGINS, misread[] = {0, 1000, 66666, 1000000};

    for (size_t i = 0; i < sizeof begins / sizeof begins[0]; i++) {
        for (size_t k = 0; k < 4u; k++) {
            run(begins[i], misread[k]);
        }
    }
    return 0;
}
