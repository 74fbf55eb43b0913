#include "@PREFIX@_lanes.h"
#include "subject.h"

static @PREFIX@_lanes all;
static plc_lanes nowhere;
static unsigned char unused;
static unsigned char *const inputs[INPUTS] = {
@UNUSED@
};
static plc_lanes *const lanes[INPUTS] = {
@INPUTS@
};
static const struct device devices[] = {
@DEVICES@
};
static uint32_t input;
static uint64_t chance;

static void reset(void)
{
    for (uint32_t i = 0; i < INPUTS; i++) {
        *lanes[i] = 0;
    }
    @PREFIX@_lanes_init(&all);
    input = 0;
    chance = 1;
}

void @PREFIX@_one_scan(uint32_t now_ms);
void @PREFIX@_one_scan(uint32_t now_ms)
{
    /* The same input as scan_times has, in some of the instances. */
    chance = chance * 6364136223846793005u + 1442695040888963407u;
    *lanes[input] ^= chance | 1u;
    input += 37;
    if (input >= INPUTS) {
        input -= INPUTS;
    }
    @PREFIX@_lanes_scan(&all, now_ms, 0);
}

const struct subject @PREFIX@_subject = {reset, @PREFIX@_one_scan, inputs, devices, @COUNT@, "@PREFIX@"};
