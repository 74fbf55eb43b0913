/*
 * rungc_lanes.h: what programs share that run in many instances at once. A bit of a program is one bit of a plc_lanes, a
 * lane, in each of PLC_LANES instances.
 */
#ifndef RUNGC_LANES_H
#define RUNGC_LANES_H

#include "rungc.h"

/* The state of one bit device in all instances: that of instance n is bit n. */
typedef uint64_t plc_lanes;

/* Number of instances. */
#define PLC_LANES 64u

/* A bit that is on in all instances. */
#define PLC_ALL_LANES UINT64_MAX

/* A bit that is the same in all instances. */
static inline plc_lanes plc_all_lanes(bool on)
{
    return on ? PLC_ALL_LANES : 0u;
}

/* A bit that is on in this instance only. */
static inline plc_lanes plc_lane(unsigned lane)
{
    return (plc_lanes)1u << lane;
}

/* The first instance in which a bit is on. It must be on in one. */
static inline unsigned plc_first_lane(plc_lanes bit)
{
#if defined(__GNUC__)
    return (unsigned)__builtin_ctzll(bit);
#else
    unsigned lane = 0;
    while ((bit & 1u) == 0u) {
        bit >>= 1;
        lane++;
    }
    return lane;
#endif
}

/* A bit's state in an instance. */
static inline bool plc_in_lane(plc_lanes bit, unsigned lane)
{
    return ((bit >> lane) & 1u) != 0u;
}

/* Writes a bit in an instance. */
static inline void plc_put_lane(plc_lanes *bit, unsigned lane, bool on)
{
    *bit = (*bit & ~plc_lane(lane)) | ((plc_lanes)on << lane);
}

/* Writes a bit in some instances; in the others it stays. */
static inline void plc_put_lanes(plc_lanes *bit, plc_lanes where, plc_lanes value)
{
    *bit = (*bit & ~where) | (value & where);
}

#endif
