/* Microseconds since the start, wrapping, with what SysTick has counted since the tick. */
static uint32_t fine_us(void)
{
    const uint32_t masked = mask_interrupts();
    uint32_t left = SYSTICK_VAL;
    uint32_t us = microseconds;

    if ((REGISTER(0xE000ED04u) & 1u << 26) != 0u) { /* ICSR: the tick waits */
        left = SYSTICK_VAL;
        us += TICK_US;
    }
    unmask_interrupts(masked);
    const uint32_t counted = SYSTICK_LOAD - left;
    const uint32_t since = CLOCK_HZ >= 1000000u ? counted / (CLOCK_HZ / 1000000u) : counted * (1000000u / CLOCK_HZ);
    return us + (since < TICK_US ? since : TICK_US - 1u);
}

