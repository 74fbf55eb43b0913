#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define CLOCK_HZ /* HZ */u
#define BITS_PER_SECOND 9600u
#define SHOWN_MS 2000u /* on-time of an output */

#define REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))
#define SYSTICK_CTRL REGISTER(0xE000E010u)
#define SYSTICK_LOAD REGISTER(0xE000E014u)
#define SYSTICK_VAL REGISTER(0xE000E018u)

/* Milliseconds since the start, wrapping. */
static volatile uint32_t milliseconds;

void systick_handler(void);

void systick_handler(void)
{
    milliseconds++;
}

/* BITS *//* SETUP *//* UART */static void print(const char *text)
{
    for (; *text != '\0'; text++) {
        put((uint8_t)*text);
    }
}

static void print_state(const char *name, const char *state)
{
    print(name);
    print(state);
    print("\r\n");
}

/* Inputs, with their names. */
static const struct {
    const char *name;
    uint32_t at, bit;
    bool inverted;
} inputs[] = {
/* INPUTS */};
#define INPUTS (sizeof inputs / sizeof inputs[0])

/* Outputs, with their names. */
static const char *const outputs[] = {
/* OUTPUTS */};
#define OUTPUTS (sizeof outputs / sizeof outputs[0])

static void switch_output(size_t number, bool on)
{
    switch (number) {
/* SWITCH */    default:
        (void)on;
        break;
    }
}

/* ANALOG *//* Says which inputs have changed; at first, all of them. */
static void report_inputs(bool first)
{
    static bool were[INPUTS];

    for (size_t i = 0; i < INPUTS; i++) {
        const bool on = ((REGISTER(inputs[i].at) & inputs[i].bit) != 0u) != inputs[i].inverted;
        if (first || on != were[i]) {
            print_state(inputs[i].name, on ? " on" : " off");
        }
        were[i] = on;
    }
}

int main(void)
{
    size_t shown = OUTPUTS; /* the output that is on */
    size_t next = 0;
    uint32_t since = 0;

/* BEGIN */    for (size_t i = 0; i < OUTPUTS; i++) {
        switch_output(i, false);
    }
    SYSTICK_CTRL = 0;
    SYSTICK_LOAD = CLOCK_HZ / 1000u - 1u;
    SYSTICK_VAL = 0;
    SYSTICK_CTRL = 7; /* the core's clock, interrupt, on */
    begin();
    print("\r\n/* BOARD */: pins only\r\nn: next output on for 2 s; a: analog inputs; any other key: output off\r\n");
    report_inputs(true);
    for (;;) {
        const int key = get();
        const bool over = shown < OUTPUTS && milliseconds - since >= SHOWN_MS;
        if ((key >= 0 || over) && shown < OUTPUTS) {
            switch_output(shown, false);
            print_state(outputs[shown], " off");
            shown = OUTPUTS;
        }
        if (key == 'n') {
            shown = next;
            next = (next + 1u) % OUTPUTS;
            since = milliseconds;
            switch_output(shown, true);
            print_state(outputs[shown], " on");
        }
/* ASKED */        report_inputs(false);
/* WATCHDOG */        __asm__ volatile("wfi");
    }
}
