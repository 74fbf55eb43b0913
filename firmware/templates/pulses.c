/* Time of the next change of a pulse output's pin, if there is one. */
static volatile uint32_t due;
static volatile bool armed;

static void wake_in(void *context, uint32_t us)
{
    (void)context;
    armed = us != UINT32_MAX;
    due = microseconds + us;
}

static void hold_pulses(void *context, bool hold)
{
    (void)context;
    if (hold) {
        __asm__ volatile("cpsid i" ::: "memory");
    } else {
        __asm__ volatile("cpsie i" ::: "memory");
    }
}

