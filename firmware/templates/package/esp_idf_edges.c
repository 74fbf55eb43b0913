/* Edges that the program counts, or that start its interrupt routines: an interrupt notes each, PROGRAM_poll takes it. */
static rungc_edges edges;

static bool next_edge(void *context, rungc_edge *edge)
{
    (void)context;
    return rungc_take_edge(&edges, edge);
}

static void note(void *argument)
{
    const terminal *at = argument;

    (void)rungc_note_edge(&edges, at->number, gpio_get_level(at->pin) == 0);
}

static void attach(uint16_t number)
{
    static bool installed = false;

    if (!installed) {
        ESP_ERROR_CHECK(gpio_install_isr_service(0));
        installed = true;
    }
    for (const terminal *at = inputs; at->number != UINT16_MAX; at++) {
        if (at->number == number && at->pin != GPIO_NUM_NC) {
            ESP_ERROR_CHECK(gpio_set_intr_type(at->pin, GPIO_INTR_ANYEDGE));
            ESP_ERROR_CHECK(gpio_isr_handler_add(at->pin, note, (void *)at));
        }
    }
}

