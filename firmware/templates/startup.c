#include <stdint.h>
#include <string.h>

/* Of image.ld. */
extern uint32_t stack_top, data_start, data_end, data_image, bss_start, bss_end;

int main(void);
void reset_handler(void);
void hard_fault(uint32_t *frame);
void systick_handler(void);
/* PROTOTYPES */
static void hang(void)
{
    for (;;) {
    }
}

void reset_handler(void)
{
#ifdef __ARM_FP
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: the floating point unit is on */
    __asm__ volatile("dsb\n\tisb");
#endif
    memcpy(&data_start, &data_image, (size_t)((char *)&data_end - (char *)&data_start));
    memset(&bss_start, 0, (size_t)((char *)&bss_end - (char *)&bss_start));
    main();
    hang();
}

/* A semihosting call (bkpt 0xAB) is a hard fault where no debugger listens: it is left out. */
__attribute__((used)) void hard_fault(uint32_t *frame)
{
    if (*(const uint16_t *)frame[6] != 0xBEABu) {
        hang();
    }
    frame[6] += 2u;
    *(volatile uint32_t *)0xE000ED2Cu = 0x80000000u; /* HFSR: the debug event was seen to */
}

__attribute__((naked)) static void hard_fault_handler(void)
{
    __asm__ volatile("mrs r0, msp\n\tb hard_fault");
}

/* BOOT2 *//* A vector is a function, but the first is the stack. */
typedef union {
    void *stack;
    void (*handler)(void);
} vector;

__attribute__((section(".vectors"), used)) static const vector vectors[/* COUNT */] = {
    {.stack = &stack_top},
    {.handler = reset_handler},
    {.handler = hang}, /* NMI */
    {.handler = hard_fault_handler},
    {.handler = hang}, /* memory management fault */
    {.handler = hang}, /* bus fault */
    {.handler = hang}, /* usage fault */
    [11] = {.handler = hang}, /* SVC */
    [14] = {.handler = hang}, /* PendSV */
    [15] = {.handler = systick_handler},
/* VECTORS */};
