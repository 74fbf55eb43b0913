/* Edges that the program counts, or that start its interrupt routines: an interrupt notes each, PROGRAM_poll takes it. */
static rungc_edges edges;
static struct gpio_callback callbacks[ARRAY_SIZE(input_pins)];

static bool next_edge(void *context, rungc_edge *edge)
{
    ARG_UNUSED(context);
    return rungc_take_edge(&edges, edge);
}

static void note(const struct device *port, struct gpio_callback *callback, uint32_t pins)
{
    const size_t i = (size_t)(callback - callbacks);

    ARG_UNUSED(port);
    ARG_UNUSED(pins);
    (void)rungc_note_edge(&edges, inputs[i], gpio_pin_get_dt(&input_pins[i]) > 0);
}

static void attach(uint16_t number)
{
    const struct gpio_dt_spec *pin = pin_of(inputs, input_pins, number);

    if (pin != NULL) {
        struct gpio_callback *callback = &callbacks[pin - input_pins];

        (void)gpio_pin_interrupt_configure_dt(pin, GPIO_INT_EDGE_BOTH);
        gpio_init_callback(callback, note, BIT(pin->pin));
        (void)gpio_add_callback(pin->port, callback);
    }
}

