/*
 * main.c: runs PROGRAM on a computer in real time, one scan every 10 ms.
 *
 * Type `X0=1` or `X0=0` and Enter to switch an input; outputs are printed when they change. Ctrl-C or `quit` stops.
 */
/* FEATURES */

#include "PROGRAM.h"
/* INCLUDE */

/* HEADERS */

#define SCAN_MS 10

static PROGRAM_plc plc_memory;
static volatile sig_atomic_t stopped;

/* Prints a line. A file that is full or closed does no harm. */
static void print(FILE *to, const char *format, ...)
{
    char line[512];
    va_list values;

    va_start(values, format);
    (void)vsnprintf(line, sizeof line, format, values);
    va_end(values);
    if (fputs(line, to) < 0 || fflush(to) != 0) {
        clearerr(to);
    }
    /* NOTE */
}

/* PARTNER */
/* Output terminals: number, name, comment. The last entry ends the table. */
static const struct {
    unsigned number;
    const char *name;
    const char *comment;
} outputs[] = {
    /* OUTPUTS */
    {0, NULL, NULL},
};

/* Sets an input terminal; false if the program has no such input. */
static bool set_input(PROGRAM_plc *plc, unsigned long number, bool on)
{
    (void)plc;
    (void)on;
    switch (number) {
    /* INPUTS */
    default:
        return false;
    }
}

/* SYSTEM */
/* Start of the next scan. After a suspension of more than a second (a suspended machine, a debugger) it does not catch up. */
static uint64_t not_late(uint64_t next)
{
    const uint64_t now = microseconds();

    if (now < next + 1000000u) {
        return next;
    }
    print(stderr, "PROGRAM: the run stood still for %lu.%lu s\n", (unsigned long)((now - next) / 1000000u),
          (unsigned long)((now - next) / 100000u % 10u));
    return now;
}

/* The first character of a text that is not a space. */
static char *without_spaces(char *text)
{
    while (*text == ' ' || *text == '\t') {
        text++;
    }
    return text;
}

/* Executes a line of standard input. */
static void execute_command(PROGRAM_plc *plc, char *line)
{
    char *const command = without_spaces(line);

    for (size_t end = strlen(command); end > 0 && (command[end - 1] == ' ' || command[end - 1] == '\t'); end--) {
        command[end - 1] = '\0';
    }
    if (strcmp(command, "quit") == 0) {
        stopped = 1;
        return;
    }
    if ((command[0] == 'X' || command[0] == 'x') && command[1] >= '0' && command[1] <= '7') {
        char *value = command;
        const unsigned long number = strtoul(command + 1, &value, 8);
        value = without_spaces(value);
        if (*value == '=') {
            value = without_spaces(value + 1);
            if ((value[0] == '0' || value[0] == '1') && value[1] == '\0' && set_input(plc, number, value[0] == '1')) {
                return;
            }
        }
    }
    print(stderr, "%s: not an input of the program; type for example X0=1\n", command);
}

/* Takes commands like X12=1 (octal) from standard input, without waiting for them, and no more in a scan than fit the buffer. */
static void read_commands(PROGRAM_plc *plc)
{
    static bool closed;
    static char line[80];
    static size_t length;
    char text[512];

    /* COMMANDS */
    if (closed) {
        return;
    }
    const long count = typed(text, sizeof text);
    closed = count < 0;
    for (long i = 0; i < count; i++) {
        const char c = text[i];
        if (c == '\r') {
            continue;
        }
        if (c != '\n') {
            if (length < sizeof line - 1) {
                line[length++] = c;
            }
            continue;
        }
        line[length] = '\0';
        length = 0;
        execute_command(plc, line);
    }
}

/* Meaning of an error code of the PLC. */
static const char *meaning(unsigned code)
{
    switch (code) {
    /* ERRORS */
    default:
        return "operation error";
    }
}

/* Instructions at which an error can occur. The last entry ends the table. */
static const struct {
    unsigned step;
    const char *text;
} instructions[] = {
    /* INSTRUCTIONS */
    {0, ""},
};

/* The place of a step's instruction in the table, that of the last entry if it has none. */
static size_t instruction_at(unsigned step)
{
    size_t i = 0;

    while (instructions[i].text[0] != '\0' && instructions[i].step != step) {
        i++;
    }
    return i;
}

/* MISSING */
/* Reports once what stopped the program. */
static void print_stop(const PROGRAM_plc *plc, uint32_t now_ms)
{
    static bool reported;
    const plc_error error = PROGRAM_error(plc);

    /* STOPPED */
    if (!reported && error.stop == PLC_STOP_WATCHDOG) {
        print(stderr, "PROGRAM: at %lu ms, step %u: %s: error %u, %s; the PLC is in STOP\n", (unsigned long)now_ms, error.stop_step,
                instructions[instruction_at(error.stop_step)].text, error.stop, meaning(error.stop));
    } else if (!reported && error.stop == PLC_STOP_M8037) {
        print(stderr, "PROGRAM: the program has stopped itself (M8037)\n");
    }
    reported = error.stop != PLC_STOP_NONE;
}

/* ON_ERROR */
/* Prints the outputs that changed. */
static void print_outputs(const PROGRAM_plc *plc, uint32_t now_ms)
{
    static bool shown[sizeof outputs / sizeof outputs[0]];

    for (size_t i = 0; outputs[i].name != NULL; i++) {
        const bool on = PROGRAM_output(plc, outputs[i].number);
        if (on != shown[i]) {
            shown[i] = on;
            print(stdout, "%7lu.%03u s  %s %-3s %s\n", (unsigned long)(now_ms / 1000u), (unsigned)(now_ms % 1000u), outputs[i].name,
                   on ? "on" : "off", outputs[i].comment);
        }
    }
}

/* CLOCK */
/* OVERRUN */
/* Prints the options. */
static void print_usage(FILE *to)
{
    /* USAGE */
}

/* Takes the options; -1: the program runs, else its exit code. */
static int read_options(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "-h") == 0 || strcmp(argv[i], "--help") == 0) {
            print_usage(stdout);
            return 0;
        }
        /* OPTIONS */
        print(stderr, "PROGRAM: %s: not an option, or its value is missing\n", argv[i]);
        print_usage(stderr);
        return 2;
    }
    return -1;
}

int main(int argc, char **argv)
{
    const int code = read_options(argc, argv);
    if (code >= 0) {
        return code;
    }
    PROGRAM_plc *const plc = &plc_memory;
    const uint64_t start = microseconds();
    uint64_t next = start;
    uint32_t scan_us = 0;

    catch_signals();
    PROGRAM_init(plc);
    /* LOAD */
    /* REPORT */
    /* HAL */
    /* ASK */
    /* BEGIN */
    while (!stopped) {
        const uint64_t begin = microseconds();
        const uint32_t now_ms = (uint32_t)((begin - start) / 1000u);
        read_commands(plc);
        /* SERVE */
        PROGRAM_scan(plc, now_ms, scan_us);
        /* GIVE */
        print_outputs(plc, now_ms);
        print_stop(plc, now_ms);
        /* SAVE */
        scan_us = (uint32_t)(microseconds() - begin);

        /* PERIOD */
        next = not_late(next);
        /* WAIT */
    }
    /* END */
    /* CONNECTIONS */
    return /* CODE */;
}
