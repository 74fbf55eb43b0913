/* The raw values of built-in analog inputs. */
static bool analog(void *context, uint8_t channel, int16_t *value)
{
    (void)context;
    switch (channel) {
/* CASES */
    default:
        return false;
    }
}

