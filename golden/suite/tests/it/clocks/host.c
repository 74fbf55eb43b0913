#include "test.h"
#include <stdio.h>

static void run(uint32_t begin, uint32_t misread)
{
    test_plc plc;
    uint32_t done = 0, changes[100];
    unsigned count = 0;
    bool on = false;

    test_init(&plc);
    plc.X0 = true;
    for (uint32_t ms = 0; ms < 12000u; ms++) {
        const uint32_t now_ms = begin + ms - (ms % 100u == 51u ? misread : 0u);
        test_tick(&plc, now_ms);
        if (ms % 5u == 1u || ms == 0u) {
            test_scan(&plc, now_ms, 0);
        }
        const uint32_t units = (ms + 5u) / 50u;
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
    test_scan(&plc, begin + 12000u, UINT32_MAX);
    printf("%d\n", plc.D2);
}

int main(void)
{
    static const uint32_t begins[] = BEGINS, misread[] = {0, 1, 66, 1000};

    for (size_t i = 0; i < sizeof begins / sizeof begins[0]; i++) {
        for (size_t k = 0; k < 4u; k++) {
            run(begins[i], misread[k]);
        }
    }
    return 0;
}
