#include "PROGRAM_board.h"
/* INCLUDE */
/* The clock that SysTick counts, the resolution of time, and the scan period. */
#define CLOCK_HZ /* HZ */u
#define TICK_US /* TICK */u
#define SCAN_US /* SCAN */u

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
#define SYSTICK_CTRL REGISTER(0xE000E010u)
#define SYSTICK_LOAD REGISTER(0xE000E014u)
#define SYSTICK_VAL REGISTER(0xE000E018u)

static PROGRAM_plc plc;
static rungc_board board;

/* Microseconds since the start, wrapping. */
static volatile uint32_t microseconds;

/* PROTOTYPES */void systick_handler(void);

/* NOW */void systick_handler(void)
{
    microseconds += TICK_US;
/* DUE */}

/* PINS *//* MODULES *//* SERIAL *//* SETUP *//* CONSOLE *//* CONTROL *//* RETAIN */static rungc_board board = {
/* HAL */    .period_us = SCAN_US,
};

int main(void)
{
/* BEGIN */    SYSTICK_LOAD = (uint32_t)((uint64_t)CLOCK_HZ * TICK_US / 1000000u) - 1u;
    SYSTICK_VAL = 0;
    PROGRAM_init(&plc);
/* LOAD */    SYSTICK_CTRL = 7; /* the core's clock, interrupt, on */
    for (;;) {
/* EXCHANGE */        PROGRAM_poll(&plc, &board);
/* SHOW */        __asm__ volatile("wfi");
    }
}
