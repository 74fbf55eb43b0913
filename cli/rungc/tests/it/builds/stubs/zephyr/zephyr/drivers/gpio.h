/* Declarations of Zephyr that the sample uses, and a devicetree with two inputs and an output. */
#ifndef ZEPHYR_DRIVERS_GPIO_H
#define ZEPHYR_DRIVERS_GPIO_H

#include <stdint.h>
#include <zephyr/kernel.h>

struct device {
    const char *name;
};

struct gpio_dt_spec {
    const struct device *port;
    uint8_t pin;
    uint16_t dt_flags;
};

struct gpio_callback;
typedef void (*gpio_callback_handler_t)(const struct device *port, struct gpio_callback *callback, uint32_t pins);
struct gpio_callback {
    gpio_callback_handler_t handler;
    uint32_t pin_mask;
};

extern const struct device gpio0;

#define GPIO_INPUT (1U << 16)
#define GPIO_OUTPUT_INACTIVE (1U << 17)
#define GPIO_INT_EDGE_BOTH (1U << 18)

#define DT_PATH(node) node
#define DT_NODE_HAS_PROP(node, property) 1
#define DT_COUNT_input_gpios(f, node, property) f(node, property, 0) f(node, property, 1)
#define DT_COUNT_output_gpios(f, node, property) f(node, property, 0)
#define DT_FOREACH_PROP_ELEM(node, property, f) DT_COUNT_##property(f, node, property)
#define GPIO_DT_SPEC_GET_BY_IDX(node, property, index) {&gpio0, index, 0}

int gpio_pin_configure_dt(const struct gpio_dt_spec *spec, uint32_t flags);
int gpio_pin_get_dt(const struct gpio_dt_spec *spec);
int gpio_pin_set_dt(const struct gpio_dt_spec *spec, int value);
int gpio_pin_interrupt_configure_dt(const struct gpio_dt_spec *spec, uint32_t flags);
void gpio_init_callback(struct gpio_callback *callback, gpio_callback_handler_t handler, uint32_t pins);
int gpio_add_callback(const struct device *port, struct gpio_callback *callback);

#endif
