static void print(const char *text)
{
    semihosting(0x04, (uint32_t)text); /* SYS_WRITE0 */
}

/* Output terminals: number, name and what is printed after the state: a comment. The last entry ends the table. */
static const struct {
    unsigned number;
    const char *name;
    const char *comment;
} outputs[] = {
/* OUTPUTS */    {0, NULL, NULL},
};

/* Prints the time, as seconds with three digits after the point. */
static void print_time(uint32_t ms)
{
    static char text[] = "      0.000 s  ";

    for (unsigned i = 0, at = 10; i < 4u || ms != 0u; i++, at--) {
        if (i == 3u) {
            at--; /* the point */
        }
        text[at] = (char)('0' + ms % 10u);
        ms /= 10u;
    }
    print(text);
}

/* Prints the outputs that changed. */
static void show_outputs(void)
{
    static bool shown[sizeof outputs / sizeof outputs[0]];

    for (size_t i = 0; outputs[i].name != NULL; i++) {
        const bool on = PROGRAM_output(&plc, outputs[i].number);
        if (on != shown[i]) {
            shown[i] = on;
            print_time(board.now_ms);
            print(outputs[i].name);
            print(on ? " on" : " off");
            print(outputs[i].comment);
            print("\n");
        }
    }
}

