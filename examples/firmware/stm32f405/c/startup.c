/* startup.c: vectors and what happens between reset and main on an STM32F405. */
#include <stdint.h>
#include <string.h>

extern uint32_t stack_top, data_start, data_end, data_image, bss_start, bss_end;

int main(void);
void systick_handler(void);
void reset_handler(void);

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

/* A vector is a function, but the first is the stack. */
typedef union {
    void *stack;
    void (*handler)(void);
} vector;

__attribute__((section(".vectors"), used)) static const vector vectors[16] = {
    {.stack = &stack_top},
    {.handler = reset_handler},
    {.handler = hang}, /* NMI */
    {.handler = hang}, /* hard fault */
    {.handler = hang}, /* memory management fault */
    {.handler = hang}, /* bus fault */
    {.handler = hang}, /* usage fault */
    [11] = {.handler = hang}, /* SVC */
    [14] = {.handler = hang}, /* PendSV */
    [15] = {.handler = systick_handler},
};
