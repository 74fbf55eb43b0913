/*
 * main.c: runs the programs of a batch as requests on standard input say, one a line; each is answered with one line: `ok`, `none`
 * (no such device, module or channel) or a decimal value. The hardware is virtual.
 */
#include "rungc_rt.h"
/* HEADERS */

#include <stdio.h>
#include <stdlib.h>

/* PLCs that a case may have. */
enum { PLCS = 4 };

/* Memory of the programs that run. */
static union {
    char empty;
    /* MEMORY */
} memories[PLCS];

/* The PLC that is meant. */
static size_t current;

#define memory (memories[current])

static rungc_hal hardware;

/* Operations on a program. */
typedef struct {
    void (*init)(void);
    void (*scan)(uint32_t now_ms, uint32_t scan_us);
    void (*set_running)(bool running);
    void (*power_cycle)(void);
    bool (*output)(unsigned terminal);
    void (*input_edge)(unsigned terminal, bool on); /* NULL if the program takes no notice of edges */
    void (*tick)(uint32_t now_ms); /* NULL if it does not follow the time */
    void (*take_interrupts)(void); /* NULL if it has no interrupts */
    rungc_map (*map)(void);
    uint32_t (*constant_scan_us)(void); /* NULL if it never requests scans of constant length */
} program;

#define CASE(n)                                                                                                        \
    static void init##n(void)                                                                                          \
    {                                                                                                                  \
        case##n##_init(&memory.case##n);                                                                               \
        memory.case##n.hal = &hardware;                                                                                \
    }                                                                                                                  \
    static void scan##n(uint32_t now_ms, uint32_t scan_us)                                                             \
    {                                                                                                                  \
        case##n##_scan(&memory.case##n, now_ms, scan_us);                                                              \
        rungc_virtual_set_running(memory.case##n.sys.running);                                                         \
    }                                                                                                                  \
    static void set_running##n(bool running)                                                                           \
    {                                                                                                                  \
        case##n##_set_running(&memory.case##n, running);                                                               \
    }                                                                                                                  \
    static void power_cycle##n(void)                                                                                   \
    {                                                                                                                  \
        case##n##_power_cycle(&memory.case##n);                                                                        \
    }                                                                                                                  \
    static bool output##n(unsigned terminal)                                                                           \
    {                                                                                                                  \
        return case##n##_output(&memory.case##n, terminal);                                                            \
    }                                                                                                                  \
    static rungc_map map##n(void)                                                                                      \
    {                                                                                                                  \
        return case##n##_map(&memory.case##n);                                                                         \
    }

#define EVENTS(n)                                                                                                      \
    static void input_edge##n(unsigned terminal, bool on)                                                              \
    {                                                                                                                  \
        case##n##_input_edge(&memory.case##n, terminal, on);                                                           \
    }

#define TIME(n)                                                                                                        \
    static void tick##n(uint32_t now_ms)                                                                               \
    {                                                                                                                  \
        case##n##_tick(&memory.case##n, now_ms);                                                                       \
    }

#define INTERRUPTS(n)                                                                                                  \
    static void take_interrupts##n(void)                                                                               \
    {                                                                                                                  \
        case##n##_take_interrupts(&memory.case##n);                                                                    \
    }

#define CONSTANT_SCAN(n)                                                                                               \
    static uint32_t constant_scan_us##n(void)                                                                          \
    {                                                                                                                  \
        return case##n##_constant_scan_us(&memory.case##n);                                                            \
    }

#define ENTRY(n, scan_us) {init##n, scan##n, set_running##n, power_cycle##n, output##n, NULL, NULL, NULL, map##n, scan_us}

#define ENTRY_WITH_EVENTS(n, scan_us)                                                                                  \
    {init##n, scan##n, set_running##n, power_cycle##n, output##n, input_edge##n, NULL, NULL, map##n, scan_us}

#define ENTRY_WITH_TIME(n, scan_us)                                                                                    \
    {init##n, scan##n, set_running##n, power_cycle##n, output##n, input_edge##n, tick##n, NULL, map##n, scan_us}

#define ENTRY_WITH_INTERRUPTS(n, scan_us)                                                                              \
    {init##n, scan##n, set_running##n, power_cycle##n, output##n, input_edge##n, tick##n, take_interrupts##n, map##n, scan_us}

/* CASES */

static const program programs[] = {
    /* ENTRIES */
    {NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL},
};

/* The class that a name means. */
static bool find_class(const char *name, rungc_class *found)
{
    static const char *const names[] = {"X", "Y", "M", "S", "T", "C", "D", "R", "V", "Z", "ER"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(name, names[i]) == 0) {
            *found = (rungc_class)i;
            return true;
        }
    }
    return false;
}

static void done(bool ok)
{
    puts(ok ? "ok" : "none");
}

/* Answers a request for a value at once: the other side waits for it. */
static void value(bool ok, long number)
{
    if (ok) {
        printf("%ld\n", number);
    } else {
        puts("none");
    }
    fflush(stdout);
}

/* Answers a request for a value of more than 32 bits. */
static void long_value(bool ok, int64_t number)
{
    if (ok) {
        printf("%lld\n", (long long)number);
    } else {
        puts("none");
    }
    fflush(stdout);
}

/* Digest of devices with one more value, or without one. */
static uint32_t with(uint32_t digest, bool found, uint32_t number)
{
    return (digest ^ (found ? number : 0x80000001u)) * 0x01000193u;
}

/* One number that stands for all that devices hold: bits, words and 32-bit counters, and terminals of outputs. */
static uint32_t digest(const program *program, rungc_class device_class, uint32_t first, uint32_t count)
{
    rungc_map map = program->map();
    uint32_t all = 0x811c9dc5u;
    for (uint32_t number = first; number - first < count; number++) {
        bool on = false;
        int16_t word = 0;
        int32_t both = 0;
        bool found = rungc_get_bit(&map, device_class, number, &on);
        all = with(all, found, on ? 1u : 0u);
        found = rungc_get_word(&map, device_class, number, &word);
        all = with(all, found, (uint32_t)word);
        if (device_class == RUNGC_CLASS_Y) {
            all = with(all, true, program->output((unsigned)number) ? 1u : 0u);
        } else if (device_class == RUNGC_CLASS_C && number >= 200u) {
            found = rungc_get_long(&map, device_class, number, &both);
            all = with(all, found, (uint32_t)both);
        }
    }
    return all;
}

/* Sets or reads a device, or reads many; false if the request is another one. */
static bool device_request(const program *program, const char *verb, const char *class_name, uint32_t number, long set)
{
    rungc_map map = program->map();
    rungc_class device_class = RUNGC_CLASS_D;
    const bool known = find_class(class_name, &device_class);
    if (strcmp(verb, "bit") == 0) {
        done(known && rungc_set_bit(&map, device_class, number, set != 0));
    } else if (strcmp(verb, "word") == 0) {
        done(known && rungc_set_word(&map, device_class, number, (int16_t)set));
    } else if (strcmp(verb, "dword") == 0) {
        done(known && rungc_set_long(&map, device_class, number, (int32_t)set));
    } else if (strcmp(verb, "getbit") == 0) {
        bool on = false;
        const bool found = known && rungc_get_bit(&map, device_class, number, &on);
        value(found, on);
    } else if (strcmp(verb, "getword") == 0) {
        int16_t word = 0;
        const bool found = known && rungc_get_word(&map, device_class, number, &word);
        value(found, word);
    } else if (strcmp(verb, "getdword") == 0) {
        int32_t both = 0;
        const bool found = known && rungc_get_long(&map, device_class, number, &both);
        value(found, both);
    } else if (strcmp(verb, "digest") == 0) {
        long_value(known, digest(program, device_class, number, (uint32_t)set));
    } else {
        return false;
    }
    return true;
}

/* Runs the program, or sets or reads the virtual hardware; false if the request is another one. */
static bool machine_request(const program *program, const char *verb, const long *number)
{
    if (strcmp(verb, "scan") == 0) {
        rungc_virtual_advance((uint32_t)number[0]);
        program->scan((uint32_t)number[0], (uint32_t)number[1]);
        done(true);
    } else if (strcmp(verb, "constant") == 0) {
        value(true, program->constant_scan_us == NULL ? 0 : (long)(program->constant_scan_us() / 1000u));
    } else if (strcmp(verb, "out") == 0) {
        value(true, program->output((unsigned)number[0]));
    } else if (strcmp(verb, "pulses") == 0) {
        rungc_map map = program->map();
        value(true, rungc_pulses_sent(&map, (uint32_t)number[0]));
    } else if (strcmp(verb, "pass") == 0) {
        rungc_map map = program->map();
        value(true, (int32_t)rungc_pass_pulses(&map, (uint32_t)number[0], (uint32_t)number[1], (uint32_t)number[2]));
    } else if (strcmp(verb, "frequency") == 0) {
        rungc_map map = program->map();
        value(true, (long)rungc_pulse_millihertz(&map, (uint32_t)number[0]));
    } else if (strcmp(verb, "edge") == 0) {
        if (program->input_edge != NULL) {
            program->input_edge((unsigned)number[0], number[1] != 0);
        }
        done(true);
    } else if (strcmp(verb, "tick") == 0) {
        if (program->tick != NULL) {
            program->tick((uint32_t)number[0]);
        }
        done(true);
    } else if (strcmp(verb, "interrupts") == 0) {
        if (program->take_interrupts != NULL) {
            program->take_interrupts();
        }
        done(true);
    } else if (strcmp(verb, "run") == 0) {
        rungc_virtual_set_running(number[0] != 0);
        program->set_running(number[0] != 0);
        done(true);
    } else if (strcmp(verb, "power") == 0) {
        rungc_virtual_restart();
        program->power_cycle();
        done(true);
    } else if (strcmp(verb, "supply") == 0) {
        rungc_virtual_set_power_fails(number[0] != 0);
        done(true);
    } else if (strcmp(verb, "clock") == 0) {
        done(rungc_virtual_set_clock((uint16_t)number[0], (uint8_t)number[1], (uint8_t)number[2], (uint8_t)number[3],
                                     (uint8_t)number[4], (uint8_t)number[5]));
    } else if (strcmp(verb, "analog") == 0) {
        done(rungc_virtual_set_analog((uint8_t)number[0], (int16_t)number[1]));
    } else {
        return false;
    }
    return true;
}

/* Fits special modules, and sets and reads their buffer memory and signals; false if the request is another one. */
static bool module_request(const char *verb, const long *number)
{
    if (strcmp(verb, "bfm") == 0) {
        done(rungc_virtual_set_bfm((uint16_t)number[0], (uint16_t)number[1], (int16_t)number[2]));
    } else if (strcmp(verb, "getbfm") == 0) {
        int16_t word = 0;
        const bool found = rungc_virtual_get_bfm((uint16_t)number[0], (uint16_t)number[1], &word);
        value(found, word);
    } else if (strcmp(verb, "fit") == 0) {
        done(rungc_virtual_fit((uint16_t)number[0], (uint16_t)number[1]));
    } else if (strcmp(verb, "delay") == 0) {
        done(rungc_virtual_delay_module((uint16_t)number[0], (uint16_t)number[1]));
    } else if (strcmp(verb, "signal") == 0) {
        rungc_virtual_advance((uint32_t)number[0]);
        done(rungc_virtual_set_signal((uint16_t)number[1], (uint8_t)number[2], (uint8_t)number[3], (int32_t)number[4]));
    } else if (strcmp(verb, "getsignal") == 0) {
        int32_t millionths = 0;
        rungc_virtual_advance((uint32_t)number[0]);
        const bool found = rungc_virtual_get_signal((uint16_t)number[1], (uint8_t)number[2], (uint8_t)number[3], &millionths);
        value(found, millionths);
    } else {
        return false;
    }
    return true;
}

/* Brings characters to serial ports and takes what they send; false if the request is another one. */
static bool line_request(const char *verb, const long *number)
{
    int64_t packed = 0;
    if (strcmp(verb, "receive") == 0) {
        done(rungc_virtual_receive((uint8_t)number[0], (uint32_t)number[1], (uint8_t)number[2], (uint8_t)number[3]));
    } else if (strcmp(verb, "sent") == 0) {
        const bool found = rungc_virtual_sent((uint8_t)number[0], (uint32_t)number[1], &packed);
        long_value(found, packed);
    } else if (strcmp(verb, "line") == 0) {
        const bool found = rungc_virtual_line((uint8_t)number[0], &packed);
        long_value(found, packed);
    } else {
        return false;
    }
    return true;
}

/* The programs of a case, one for each PLC. */
static const program *running[PLCS];
static size_t running_count;

/* Starts program `number` in the next PLC of the case. */
static bool start(long number)
{
    const size_t count = sizeof programs / sizeof programs[0] - 1;
    if (number < 0 || (size_t)number >= count || running_count == PLCS) {
        return false;
    }
    const size_t before = current;
    current = running_count;
    rungc_virtual_select((uint32_t)current);
    rungc_virtual_reset();
    running[current] = &programs[number];
    running[current]->init();
    running_count++;
    current = before;
    rungc_virtual_select((uint32_t)current);
    return true;
}

/* Chooses the programs of a case, and which of them is meant; false if the request is another one. */
static bool case_request(const char *verb, const long *number)
{
    if (strcmp(verb, "case") == 0) {
        current = 0;
        running_count = 0;
        done(start(number[0]));
    } else if (strcmp(verb, "join") == 0) {
        done(start(number[0]));
    } else if (strcmp(verb, "plc") == 0) {
        const bool found = number[0] >= 0 && (size_t)number[0] < running_count;
        if (found) {
            current = (size_t)number[0];
            rungc_virtual_select((uint32_t)current);
        }
        done(found);
    } else {
        return false;
    }
    return true;
}

/* The words of a request; those that are missing are empty. */
enum { WORDS = 7 };

static void split(char *line, char *words[WORDS])
{
    for (size_t i = 0; i < WORDS; i++) {
        line += strspn(line, " \n");
        words[i] = line;
        line += strcspn(line, " \n");
        if (*line != '\0') {
            *line = '\0';
            line++;
        }
    }
}

int main(void)
{
    static char line[256];

    hardware = rungc_virtual_hal();
    while (fgets(line, sizeof line, stdin) != NULL) {
        char *words[WORDS];
        long number[WORDS - 1];
        split(line, words);
        for (size_t i = 0; i < WORDS - 1; i++) {
            number[i] = strtol(words[i + 1], NULL, 10);
        }
        if (strcmp(words[0], "exit") == 0) {
            break;
        }
        if (case_request(words[0], number)) {
            continue;
        }
        if (running_count == 0) {
            done(false);
            continue;
        }
        const program *program = running[current];
        if (!device_request(program, words[0], words[1], (uint32_t)number[1], number[2]) &&
            !machine_request(program, words[0], number) && !module_request(words[0], number) &&
            !line_request(words[0], number)) {
            value(false, 0);
        }
    }
    fflush(stdout);
    return 0;
}
