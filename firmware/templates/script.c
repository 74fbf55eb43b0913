/* Inputs that switch themselves, in the order of time. */
static const struct {
    uint32_t ms;
    uint16_t number;
    bool on;
} script[] = {
/* SCRIPT */};

/* Returns true if an input is scripted, with its present state. */
static bool scripted(uint16_t number, bool *on)
{
    bool any = false;

    *on = false;
    for (size_t i = 0; i < sizeof script / sizeof script[0]; i++) {
        if (script[i].number == number) {
            any = true;
            if (script[i].ms <= board.now_ms) {
                *on = script[i].on;
            }
        }
    }
    return any;
}

