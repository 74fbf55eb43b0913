/* board.c: an STM32F4 Discovery, or QEMU's netduinoplus2. The button is PA0, the lamps are PD11 to PD15. */
#include "board.h"

/* The core's clock: 16 MHz after reset; QEMU's machine has 168 MHz. */
#ifdef DEMO
#define CPU_HZ 168000000u
#else
#define CPU_HZ 16000000u
#endif

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define RCC_AHB1ENR REGISTER(0x40023830u)
#define GPIOA_IDR REGISTER(0x40020010u)
#define GPIOD_MODER REGISTER(0x40020C00u)
#define GPIOD_BSRR REGISTER(0x40020C18u)
#define SYSTICK_CTRL REGISTER(0xE000E010u)
#define SYSTICK_LOAD REGISTER(0xE000E014u)
#define SYSTICK_VAL REGISTER(0xE000E018u)

#define FIRST_LAMP 11u

static volatile uint32_t milliseconds, microseconds;

void systick_handler(void);

void systick_handler(void)
{
    static uint32_t part_us;

    microseconds += BOARD_TICK_US;
    part_us += BOARD_TICK_US;
    if (part_us >= 1000u) {
        part_us -= 1000u;
        milliseconds++;
    }
    board_tick_handler(microseconds);
}

void board_init(void)
{
    RCC_AHB1ENR |= 1u << 0 | 1u << 3; /* clocks of ports A and D */
    GPIOD_MODER = (GPIOD_MODER & 0x003FFFFFu) | 0x55400000u; /* PD11 to PD15 are outputs */
    SYSTICK_LOAD = CPU_HZ / 1000000u * BOARD_TICK_US - 1u;
    SYSTICK_VAL = 0;
    SYSTICK_CTRL = 7; /* core clock, interrupt, on */
}

uint32_t board_millis(void)
{
    return milliseconds;
}

uint32_t board_micros(void)
{
    return microseconds;
}

void board_hold_interrupts(bool hold)
{
    if (hold) {
        __asm__ volatile("cpsid i" ::: "memory");
    } else {
        __asm__ volatile("cpsie i" ::: "memory");
    }
}

void board_sleep(void)
{
    __asm__ volatile("wfi");
}

bool board_button(void)
{
    return (GPIOA_IDR & 1u) != 0;
}

void board_lamp(unsigned lamp, bool on)
{
    const uint32_t pin = 1u << (FIRST_LAMP + lamp);
    GPIOD_BSRR = on ? pin : pin << 16;
}

static void semihosting(uint32_t operation, uint32_t argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register uint32_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

void board_print(const char *text)
{
    semihosting(0x04, (uint32_t)text); /* SYS_WRITE0 */
}

void board_exit(void)
{
    semihosting(0x18, 0x20026); /* SYS_EXIT, application exit */
    for (;;) {
    }
}
