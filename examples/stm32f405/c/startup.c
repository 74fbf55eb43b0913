/* startup.c: vectors and what happens between reset and main on a Cortex-M3 or M4. */
#include <stdint.h>
#include <string.h>

extern uint32_t stack_top, data_start, data_end, data_image, bss_start, bss_end;

int main(void);
void fault_handler(void);
void systick_handler(void);
void reset_handler(void);

/* A program that is lost stays where it is, unless it has a handler of its own. */
__attribute__((weak)) void fault_handler(void)
{
    for (;;) {
    }
}

__attribute__((weak, alias("fault_handler"))) void systick_handler(void);

void reset_handler(void)
{
#ifdef __ARM_FP
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20; /* CPACR: access to the floating-point unit */
    __asm__ volatile("dsb\n\tisb");
#endif
    memcpy(&data_start, &data_image, (size_t)((char *)&data_end - (char *)&data_start));
    memset(&bss_start, 0, (size_t)((char *)&bss_end - (char *)&bss_start));
    main();
    fault_handler();
}

/* A vector is a function, but the first is the stack. */
typedef union {
    void *stack;
    void (*handler)(void);
} vector;

__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    {.stack = &stack_top},
    {.handler = reset_handler},
    {.handler = fault_handler}, /* NMI */
    {.handler = fault_handler}, /* hard fault */
    {.handler = fault_handler}, /* memory management fault */
    {.handler = fault_handler}, /* bus fault */
    {.handler = fault_handler}, /* usage fault */
    [11] = {.handler = fault_handler}, /* SVC */
    [14] = {.handler = fault_handler}, /* PendSV */
    [15] = {.handler = systick_handler},
};
