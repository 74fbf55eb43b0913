/* stepper.c: a stepper motor on an STM32F405. Pulses are on PD11, which an interrupt switches every 50 us at the soonest. */
#include "board.h"
#include "stepper.h"

#define SCAN_MS 1u

static stepper_plc plc;

/* When the next pin changes, in microseconds. */
static volatile uint32_t due;

/* The program drives a pin: here as soon as a pulse begins or ends. */
static void set_output(void *context, uint16_t number, bool on)
{
    (void)context;
    board_lamp(number, on);
}

/* The program changes a train of pulses, in which no interrupt must find it. */
static void hold_pulses(void *context, bool hold)
{
    (void)context;
    board_hold_interrupts(hold);
}

static const rungc_hal hal = {.set_output = set_output, .hold_pulses = hold_pulses};

/* In an interrupt: switches the pins whose time has come. */
void board_tick_handler(uint32_t now_us)
{
    if ((int32_t)(now_us - due) >= 0) {
        const uint32_t wait = stepper_pulse_timer(&plc, now_us);
        due = now_us + (wait < 1000000u ? wait : 1000000u);
    }
}

#ifdef DEMO
/* Under QEMU nobody presses the button: it is on from 10 to 20 ms. The end comes when the steps are done. */
static bool start(uint32_t now_ms)
{
    return now_ms >= 10u && now_ms < 20u;
}

static void end(uint32_t now_ms)
{
    static char line[] = "done after 0000 ms\n";

    if (plc.Y1) {
        for (unsigned i = 0; i < 4u; i++) {
            line[14u - i] = (char)('0' + now_ms % 10u);
            now_ms /= 10u;
        }
        board_print(line);
        board_exit();
    }
}
#else
static bool start(uint32_t now_ms)
{
    (void)now_ms;
    return board_button();
}

static void end(uint32_t now_ms)
{
    (void)now_ms;
}
#endif

int main(void)
{
    uint32_t next = 0;

    board_init();
    stepper_init(&plc);
    plc.hal = &hal;
    for (;;) {
        const uint32_t now = board_millis();
        if ((int32_t)(now - next) >= 0) {
            plc.X0 = start(now);
            stepper_scan(&plc, now, 0);
            due = board_micros(); /* it may have begun pulses */
            board_lamp(1, stepper_output(&plc, 1));
            board_lamp(2, stepper_output(&plc, 2));
            end(now);
            next = now + SCAN_MS;
        }
        board_sleep();
    }
}
