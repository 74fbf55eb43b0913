/* Runs the program on an ESP32. The pins are an example: change them for your board. */
#include "PROGRAM_board.h"
#include "driver/gpio.h"
#include "esp_timer.h"
#include "freertos/FreeRTOS.h"
#include "freertos/task.h"

/* A terminal of the PLC and its pin. */
typedef struct terminal {
    uint16_t number; /* 8 is X010 or Y010 */
    gpio_num_t pin;
} terminal;

/* An input is on while its pin is connected to ground. */
static const terminal inputs[] = {
/* INPUTS */    {UINT16_MAX, GPIO_NUM_NC}};
static const terminal outputs[] = {
/* OUTPUTS */    {UINT16_MAX, GPIO_NUM_NC}};

static PROGRAM_plc plc;
static rungc_board board;

/* The pin of a terminal; GPIO_NUM_NC: it has none. */
static gpio_num_t pin_of(const terminal *terminals, uint16_t number)
{
    while (terminals->number != number && terminals->number != UINT16_MAX) {
        terminals++;
    }
    return terminals->pin;
}

static bool read_input(void *context, uint16_t number, bool *on)
{
    const gpio_num_t pin = pin_of(inputs, number);

    (void)context;
    *on = pin != GPIO_NUM_NC && gpio_get_level(pin) == 0;
    return pin != GPIO_NUM_NC;
}

static void write_output(void *context, uint16_t number, bool on)
{
    const gpio_num_t pin = pin_of(outputs, number);

    (void)context;
    if (pin != GPIO_NUM_NC) {
        (void)gpio_set_level(pin, on ? 1u : 0u);
    }
}

static uint32_t now_us(void *context)
{
    (void)context;
    return (uint32_t)esp_timer_get_time();
}

/* EDGES */void app_main(void)
{
    for (const terminal *at = inputs; at->number != UINT16_MAX; at++) {
        if (at->pin != GPIO_NUM_NC) {
            ESP_ERROR_CHECK(gpio_set_direction(at->pin, GPIO_MODE_INPUT));
            ESP_ERROR_CHECK(gpio_set_pull_mode(at->pin, GPIO_PULLUP_ONLY));
        }
    }
    for (const terminal *at = outputs; at->number != UINT16_MAX; at++) {
        if (at->pin != GPIO_NUM_NC) {
            ESP_ERROR_CHECK(gpio_set_direction(at->pin, GPIO_MODE_OUTPUT));
        }
    }
    board.hal.input = read_input;
    board.hal.set_output = write_output;
    board.now_us = now_us;
    board.period_us = 10000u; /* a scan every 10 ms */
/* ATTACH */    PROGRAM_init(&plc);
    for (;;) {
        PROGRAM_poll(&plc, &board);
        vTaskDelay(1); /* a tick: 10 ms, unless CONFIG_FREERTOS_HZ says otherwise */
    }
}
