/* traffic_light.c: the traffic light of examples/programs on an STM32F405. */
#include "board.h"
#include "traffic_light.h"

#define SCAN_MS 10u
#define LAMPS 5u

static traffic_light_plc plc;

/* There are no pulses. */
void board_tick_handler(uint32_t now_us)
{
    (void)now_us;
}

#ifdef DEMO
/* Under QEMU, the button is pressed automatically: it is on from 2.0 to 2.1 s. What the lamps do is printed, for 30 s. */
static bool button(uint32_t now_ms)
{
    return now_ms >= 2000u && now_ms < 2100u;
}

static void show(unsigned lamp, bool on, uint32_t now_ms)
{
    static char line[] = "00.00 s  Y0 on \n";
    static const char state[2][4] = {"off", "on "};
    const uint32_t hundredths = now_ms / 10u;

    line[0] = (char)('0' + hundredths / 1000u % 10u);
    line[1] = (char)('0' + hundredths / 100u % 10u);
    line[3] = (char)('0' + hundredths / 10u % 10u);
    line[4] = (char)('0' + hundredths % 10u);
    line[10] = (char)('0' + lamp);
    for (unsigned i = 0; i < 3u; i++) {
        line[12u + i] = state[on][i];
    }
    board_print(line);
}

static bool is_over(uint32_t now_ms)
{
    return now_ms >= 30000u;
}
#else
static bool button(uint32_t now_ms)
{
    (void)now_ms;
    return board_button();
}

static void show(unsigned lamp, bool on, uint32_t now_ms)
{
    (void)lamp;
    (void)on;
    (void)now_ms;
}

static bool is_over(uint32_t now_ms)
{
    (void)now_ms;
    return false;
}
#endif

/* Sets the lamps that changed. */
static void write_lamps(uint32_t now_ms)
{
    static bool lamps[LAMPS];

    for (unsigned i = 0; i < LAMPS; i++) {
        const bool on = traffic_light_output(&plc, i);
        if (on != lamps[i]) {
            lamps[i] = on;
            board_lamp(i, on);
            show(i, on, now_ms);
        }
    }
}

int main(void)
{
    uint32_t next = 0;

    board_init();
    traffic_light_init(&plc);
    for (;;) {
        const uint32_t now = board_millis();
        if ((int32_t)(now - next) >= 0) {
            plc.X0 = button(now);
            traffic_light_scan(&plc, now, 0);
            write_lamps(now);
            next = now + SCAN_MS;
        }
        if (is_over(now)) {
            board_exit();
        }
        board_sleep();
    }
}
