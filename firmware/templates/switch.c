/* The RUN/STOP switch as it was last followed. */
static bool switch_is_run;

static bool reads_run(void)
{
    return /* READ */;
}

/* Follows the switch when it has been in its new position for 20 ms; what HMIs and special relays do in between stays. */
static void follow_switch(void)
{
    static uint32_t since;

    if (reads_run() == switch_is_run) {
        since = microseconds;
    } else if (microseconds - since >= 20000u) {
        switch_is_run = !switch_is_run;
        PROGRAM_set_running(&plc, switch_is_run);
    }
}

