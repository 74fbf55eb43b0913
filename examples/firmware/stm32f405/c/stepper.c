/* stepper.c: a stepper motor on an STM32F405. Pulses are on PD11, which an interrupt switches every 50 us at the soonest; it also notes
   when the button is pressed and let go. */
#include "board.h"
#include "stepper_board.h"

static stepper_plc plc;

/* When the next pin changes, in microseconds. */
static volatile uint32_t due;

/* What the button did. */
static rungc_edges edges;

static uint32_t now_us(void *context)
{
    (void)context;
    return board_micros();
}

/* The button. Under QEMU, it is pressed automatically: it is on from 10 to 20 ms. */
static bool button(uint32_t now)
{
#ifdef DEMO
    return now >= 10000u && now < 20000u;
#else
    (void)now;
    return board_button();
#endif
}

/* X0 is the button. */
static bool input(void *context, uint16_t number, bool *on)
{
    (void)context;
    *on = button(board_micros());
    return number == 0u;
}

static bool next_edge(void *context, rungc_edge *edge)
{
    (void)context;
    return rungc_take_edge(&edges, edge);
}

static void set_output(void *context, uint16_t number, bool on)
{
    (void)context;
    board_lamp(number, on);
}

static void hold_pulses(void *context, bool hold)
{
    (void)context;
    board_hold_interrupts(hold);
}

static void wake_in(void *context, uint32_t us)
{
    (void)context;
    due = board_micros() + (us < 1000000u ? us : 1000000u);
}

static rungc_board board = {
    .hal = {.input = input, .set_output = set_output, .hold_pulses = hold_pulses},
    .now_us = now_us,
    .next_edge = next_edge,
    .wake_in = wake_in,
    .followed = 1u, /* X0 */
    .period_us = 1000u,
};

/* In an interrupt: notes edges of the button, and switches the pins whose time has come. */
void board_tick_handler(uint32_t now)
{
    static bool was_on;
    const bool on = button(now);

    if (on != was_on) {
        was_on = on;
        (void)rungc_note_edge(&edges, 0, on);
    }
    if ((int32_t)(now - due) >= 0) {
        stepper_on_timer(&plc, &board);
    }
}

/* Under QEMU the end comes when the steps are done. */
static void end(void)
{
#ifdef DEMO
    static char line[] = "done after 0000 ms\n";
    uint32_t now_ms = board_millis();

    if (plc.Y1) {
        for (unsigned i = 0; i < 4u; i++) {
            line[14u - i] = (char)('0' + now_ms % 10u);
            now_ms /= 10u;
        }
        board_print(line);
        board_exit();
    }
#endif
}

int main(void)
{
    stepper_init(&plc);
    board_init();
    for (;;) {
        stepper_poll(&plc, &board);
        end();
        board_sleep();
    }
}
