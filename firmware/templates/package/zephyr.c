/* Runs the program on Zephyr. The devicetree says which pins its terminals have: see app.overlay. */
#include "PROGRAM_board.h"
#include <zephyr/drivers/gpio.h>
#include <zephyr/kernel.h>

#define USER DT_PATH(zephyr_user)
#define PIN(node, property, index) GPIO_DT_SPEC_GET_BY_IDX(node, property, index),

/* The terminals of the PLC, in the order of their pins in the devicetree; 8 is X010 or Y010. UINT16_MAX ends the list. */
static const uint16_t inputs[] = {/* INPUTS */UINT16_MAX};
static const uint16_t outputs[] = {/* OUTPUTS */UINT16_MAX};
static const struct gpio_dt_spec input_pins[] = {
#if DT_NODE_HAS_PROP(USER, input_gpios)
    DT_FOREACH_PROP_ELEM(USER, input_gpios, PIN)
#endif
    {0}};
static const struct gpio_dt_spec output_pins[] = {
#if DT_NODE_HAS_PROP(USER, output_gpios)
    DT_FOREACH_PROP_ELEM(USER, output_gpios, PIN)
#endif
    {0}};

static PROGRAM_plc plc;
static rungc_board board;

/* The pin of a terminal; NULL: it has none. */
static const struct gpio_dt_spec *pin_of(const uint16_t *terminals, const struct gpio_dt_spec *pins, uint16_t number)
{
    for (size_t i = 0; terminals[i] != UINT16_MAX && pins[i].port != NULL; i++) {
        if (terminals[i] == number) {
            return &pins[i];
        }
    }
    return NULL;
}

static bool read_input(void *context, uint16_t number, bool *on)
{
    const struct gpio_dt_spec *pin = pin_of(inputs, input_pins, number);

    ARG_UNUSED(context);
    *on = pin != NULL && gpio_pin_get_dt(pin) > 0;
    return pin != NULL;
}

static void write_output(void *context, uint16_t number, bool on)
{
    const struct gpio_dt_spec *pin = pin_of(outputs, output_pins, number);

    ARG_UNUSED(context);
    if (pin != NULL) {
        (void)gpio_pin_set_dt(pin, on ? 1 : 0);
    }
}

static uint32_t now_us(void *context)
{
    ARG_UNUSED(context);
    return (uint32_t)k_ticks_to_us_floor64(k_uptime_ticks());
}

/* EDGES */int main(void)
{
    for (size_t i = 0; input_pins[i].port != NULL; i++) {
        (void)gpio_pin_configure_dt(&input_pins[i], GPIO_INPUT);
    }
    for (size_t i = 0; output_pins[i].port != NULL; i++) {
        (void)gpio_pin_configure_dt(&output_pins[i], GPIO_OUTPUT_INACTIVE);
    }
    board.hal.input = read_input;
    board.hal.set_output = write_output;
    board.now_us = now_us;
    board.period_us = 10000u; /* a scan every 10 ms */
/* ATTACH */    PROGRAM_init(&plc);
    for (;;) {
        PROGRAM_poll(&plc, &board);
        k_usleep(500);
    }
    return 0;
}
