/* subject.h: a program to measure, however it was made. */
#ifndef SUBJECT_H
#define SUBJECT_H

#include <stdbool.h>
#include <stdint.h>

/* What changes from scan to scan: X000 to X177, then the mode flags M0 to M15. */
#define INPUTS 144u

/* A bit (1 byte, 0 or 1) or a word (2 bytes) of a program. */
struct device {
    const void *at;
    uint8_t bytes;
};

struct subject {
    void (*reset)(void);            /* power on */
    void (*scan)(uint32_t now_ms);  /* one scan */
    unsigned char *const *inputs;   /* INPUTS bytes, 0 or 1 */
    const struct device *devices;   /* what is compared, the same devices in the same order for each implementation */
    uint32_t device_count;
    const char *name;
};

/* A subject in use. */
struct run {
    const struct subject *subject;
    uint32_t now_ms;
    uint32_t input; /* which one changes next */
};

/* Scans this many times, 10 ms apart, with one input changed before each scan. */
static inline void scan_times(struct run *run, uint32_t scans)
{
    const struct subject *const subject = run->subject;
    uint32_t now_ms = run->now_ms, input = run->input;

    for (; scans != 0; scans--) {
        *subject->inputs[input] ^= 1;
        input += 37;
        if (input >= INPUTS) {
            input -= INPUTS;
        }
        now_ms += 10;
        subject->scan(now_ms);
    }
    run->now_ms = now_ms;
    run->input = input;
}

/* The states of all devices, added to a checksum. */
static inline uint32_t checksum(const struct subject *subject, uint32_t sum)
{
    for (uint32_t i = 0; i < subject->device_count; i++) {
        const unsigned char *const at = subject->devices[i].at;
        uint32_t value = at[0];
        if (subject->devices[i].bytes == 2) {
            value |= (uint32_t)at[1] << 8;
        } else {
            value &= 1u; /* of the first instance */
        }
        sum = (sum ^ value) * 16777619u;
    }
    return sum;
}

/* Resets, and scans with a checksum of all states after each scan. */
static inline uint32_t check(struct run *run, uint32_t scans)
{
    uint32_t sum = 2166136261u;

    for (uint32_t i = 0; i < INPUTS; i++) {
        *run->subject->inputs[i] = 0;
    }
    run->subject->reset();
    run->now_ms = 0;
    run->input = 0;
    for (; scans != 0; scans--) {
        scan_times(run, 1);
        sum = checksum(run->subject, sum);
    }
    return sum;
}

#endif
