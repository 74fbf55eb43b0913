/* Values of converters. */
static const struct {
    const char *name;
    uint32_t at;
    uint32_t start, word, ready; /* start of the converter, or 0 */
} analog[] = {
/* ROWS */};

static void report_analog(void)
{
    for (size_t i = 0; i < sizeof analog / sizeof analog[0]; i++) {
        char text[] = " 00000";
        if (analog[i].start != 0u) {
            REGISTER(analog[i].start) = analog[i].word;
            while ((REGISTER(analog[i].start) & analog[i].ready) == 0u) {
            }
        }
        uint32_t count = REGISTER(analog[i].at) & 0xFFFFu;
        for (size_t digit = 5; digit > 0u; digit--) {
            text[digit] = (char)('0' + count % 10u);
            count /= 10u;
        }
        print_state(analog[i].name, text);
    }
}

