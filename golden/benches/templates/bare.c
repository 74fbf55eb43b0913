/* bare.c: checks all subjects and counts their instructions, on a Cortex-M4 under QEMU with `-icount shift=0`, where each instruction
 * takes a nanosecond. Prints a line for each: its name, checksum, ticks of the core's clock (168 MHz) for SCANS scans. */
#include "board.h"
#include "subjects.h"

#define COUNT (sizeof subjects / sizeof *subjects)
#define REGISTER(address) (*(volatile uint32_t *)(address))
#define SYSTICK_CTRL REGISTER(0xE000E010u)
#define SYSTICK_LOAD REGISTER(0xE000E014u)
#define SYSTICK_VAL REGISTER(0xE000E018u)
#define SYSTICK_MAX 0xFFFFFFu

/* There is no tick. */
void board_tick_handler(uint32_t now_us)
{
    (void)now_us;
}

static void print_hex(uint32_t value)
{
    char text[10] = " ";
    for (unsigned digit = 0; digit < 8u; digit++) {
        text[1u + digit] = "0123456789abcdef"[value >> (28u - 4u * digit) & 15u];
    }
    text[9] = 0;
    board_print(text);
}

static void scan_nothing(uint32_t now_ms)
{
    (void)now_ms;
}

static void measure(const struct subject *subject)
{
    struct run run = {.subject = subject};
    const uint32_t sum = check(&run, CHECK_SCANS);
    SYSTICK_LOAD = SYSTICK_MAX;
    SYSTICK_VAL = 0;
    SYSTICK_CTRL = 5; /* core clock, no interrupt, on */
    const uint32_t start = SYSTICK_VAL;
    scan_times(&run, SCANS);
    const uint32_t ticks = (start - SYSTICK_VAL) & SYSTICK_MAX;
    SYSTICK_CTRL = 0;
    board_print(subject->name);
    print_hex(sum);
    print_hex(ticks);
    board_print("\n");
}

int main(void)
{
    /* What the loop around a scan takes, first: the same inputs change, nothing is scanned. */
    struct subject nothing = *subjects[0];
    nothing.scan = scan_nothing;
    nothing.name = "nothing";
    measure(&nothing);
    for (unsigned s = 0; s < COUNT; s++) {
        measure(subjects[s]);
    }
    board_exit();
}
