/* host.c: checks all subjects and times them in turns. Arguments: scans to check, rounds, microseconds that a turn takes about.
 * Prints a line for each: its name, checksums at the start and at the end, and the nanoseconds that a scan took in each round. */
#define _POSIX_C_SOURCE 199309L
#include "subjects.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define COUNT (sizeof subjects / sizeof *subjects)

static double now_ns(void)
{
    struct timespec time;
    /* What others do meanwhile does not count. */
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

static double time_scans(struct run *run, uint32_t scans)
{
    const double start = now_ns();
    scan_times(run, scans);
    return now_ns() - start;
}

int main(int count, char **arguments)
{
    static struct run runs[COUNT];
    uint32_t sums[COUNT];

    if (count != 4) {
        return 2;
    }
    const uint32_t check_scans = (uint32_t)atoi(arguments[1]);
    const uint32_t rounds = (uint32_t)atoi(arguments[2]);
    const double turn_ns = 1e3 * atof(arguments[3]);
    double *const times = calloc(COUNT * rounds + 1, sizeof *times);
    if (times == NULL) {
        return 2;
    }
    for (size_t s = 0; s < COUNT; s++) {
        runs[s].subject = subjects[s];
        sums[s] = check(&runs[s], check_scans);
    }
    uint32_t scans = 1;
    while (rounds != 0 && time_scans(&runs[0], scans) < turn_ns) {
        scans *= 2;
    }
    /* All subjects have scanned equally often at the end. */
    for (size_t s = 1; rounds != 0 && s < COUNT; s++) {
        for (uint32_t n = 1; n <= scans; n *= 2) {
            scan_times(&runs[s], n);
        }
    }
    for (uint32_t round = 0; round < rounds; round++) {
        for (size_t turn = 0; turn < COUNT; turn++) {
            const size_t s = (round + turn) % COUNT;
            times[s * rounds + round] = time_scans(&runs[s], scans) / scans;
        }
    }
    for (size_t s = 0; s < COUNT; s++) {
        printf("%s %08x %08x", subjects[s]->name, sums[s], checksum(subjects[s], 0));
        for (uint32_t round = 0; round < rounds; round++) {
            printf(" %.3f", times[s * rounds + round]);
        }
        printf("\n");
    }
    free(times);
    return 0;
}
