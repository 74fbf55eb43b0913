/* blink.c: a lamp that blinks, by a PLC program and with nothing below it. */
#include "blink.h"
#include "board.h"

static blink_plc plc;

/* There are no pulses. */
void board_tick_handler(uint32_t now_us)
{
    (void)now_us;
}

int main(void)
{
    board_init();
    blink_init(&plc);
    for (;;) {
        blink_scan(&plc, board_millis(), 0);
        board_lamp(0, blink_output(&plc, 0));
        board_sleep();
    }
}
