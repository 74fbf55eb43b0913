/* Scans the program `arith` with random registers and inputs and shows a sum of all that it stores: the same on every machine. */
#include <arith_access.h>

static arith_plc plc;
static uint32_t seed = 12345u;

static uint16_t next(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (uint16_t)(seed >> 16);
}

static uint32_t sum_of(uint8_t device_class, uint32_t count, uint32_t sum)
{
    int32_t value = 0;

    for (uint32_t number = 0; number < count; number++) {
        if (arith_read(&plc, device_class, number, &value)) {
            sum = (sum ^ (uint32_t)value) * 16777619u;
        }
    }
    return sum;
}

static void compare(void (*show)(uint32_t sum))
{
    static const int32_t special[] = {0, 1, -1, INT16_MAX, INT16_MIN};
    uint32_t now_ms = 0;

    arith_init(&plc);
    for (int scan = 0; scan < 300; scan++) {
        uint32_t sum = 2166136261u;
        for (uint32_t number = 0; number < 4; number++) {
            int32_t value = (int16_t)next();
            if (next() % 4u == 0u) {
                value = special[next() % 5u];
            }
            (void)arith_write(&plc, PLC_CLASS_D, number, value);
        }
        for (uint32_t number = 0; number < 16; number++) {
            (void)arith_write(&plc, PLC_CLASS_X, number, next() % 2u);
        }
        arith_scan(&plc, now_ms, next());
        now_ms += next() % 256u;
        sum = sum_of(PLC_CLASS_D, 120, sum);
        sum = sum_of(PLC_CLASS_M, 120, sum);
        sum = sum_of(PLC_CLASS_Y, 8, sum);
        sum = sum_of(PLC_CLASS_T, 1, sum);
        sum = sum_of(PLC_CLASS_C, 201, sum);
        show(sum ^ arith_error(&plc).code);
    }
}
