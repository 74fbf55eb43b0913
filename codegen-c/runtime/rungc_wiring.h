/*
 * rungc_wiring.h: the special devices of pulse outputs, by families of models.
 *
 * Private to the rungc_*.c files. Numbers are 0 where a model has no such device.
 */
#ifndef RUNGC_WIRING_H
#define RUNGC_WIRING_H

#include "rungc_rt.h"

/* Registers with the speeds and times of ramps. */
typedef struct rungc_ramps {
    uint16_t base;    /* speed that ramps begin and end with, in Hz */
    uint16_t highest; /* pair: highest speed, in Hz */
    uint16_t up;      /* milliseconds from 0 to the highest speed */
    uint16_t down;    /* milliseconds from the highest speed to 0 */
} rungc_ramps;

/* A signal that clears the counter of a servo amplifier at the origin. */
typedef struct rungc_clear {
    uint16_t enable;  /* relay without which there is none */
    uint16_t output;  /* output Y on which it is given, unless a register says another */
    uint16_t number;  /* that register */
    uint16_t chooses; /* relay without which the register is ignored; 0: it always counts */
    uint16_t ms;      /* on-time, in addition to the scan in which it starts */
    bool octal;       /* the hexadecimal digits of the register are those of the output's octal number */
} rungc_clear;

/* The special devices of a return to the origin by DSZR. */
typedef struct rungc_home {
    uint16_t forward;       /* relay: it returns forward; 0: the model has no DSZR */
    uint16_t limits[2];     /* relays of limit switches: forward, reverse */
    uint16_t dog_inverted;  /* relay: the DOG is on where its input is off */
    uint16_t zero_inverted; /* relay: the zero signal likewise */
    rungc_ramps ramps;      /* speeds and times */
    uint16_t creep;         /* register: speed over the DOG, in Hz */
    uint16_t speed;         /* pair: speed of the return, in Hz */
    rungc_clear clear;      /* its signal */
} rungc_home;

/* The signal for which DVIT waits. */
typedef struct rungc_interrupt {
    uint16_t input;    /* input X that gives it, unless a register says another */
    uint16_t chooses;  /* relay with which the register counts */
    uint16_t number;   /* that register: a hexadecimal digit for each output; 0 to 7 for X000 to X007, 8 for the relay */
    uint16_t relay;    /* relay that gives the signal in an input's place */
    uint16_t inverted; /* relay: the signal is there where the input is off */
} rungc_interrupt;

/* The special devices of one output. */
typedef struct rungc_wiring {
    uint16_t axis;             /* HM: first register of the axis */
    uint16_t position;         /* pair: the position, which positioning instructions count */
    uint16_t pulses;           /* pair: the pulses of PLSY and PLSR */
    uint16_t sum;              /* pair: the pulses of several outputs */
    uint16_t busy[2];          /* relays that show that pulses are sent */
    uint16_t stop[2];          /* relays that stop the pulses at once */
    uint16_t driven;           /* relay that shows that an instruction for this output is driven */
    uint16_t restart;          /* relay with which a driven instruction begins anew, or takes the output from another one */
    uint16_t changes;          /* relay with which numbers of pulses may change, and `own` holds instead of `ramps` */
    rungc_ramps ramps;         /* ramps of positioning */
    rungc_ramps own;           /* ramps of this output alone */
    uint16_t slides;           /* relay with which PLSV has ramps */
    uint16_t limits[2];        /* relays of limit switches, forward and reverse, at which all instructions come down */
    uint16_t aborted;          /* relay that shows that an instruction came to an end before its time */
    uint16_t micro;            /* relay with which the unit of PWM is 1 us instead of 1 ms */
    uint16_t inverts;          /* relay that inverts the pin while PWM is sent */
    uint16_t unit;             /* register with the unit of PWM: 0 and 1 for 10 us, 2 for 1 ms, 3 for 10 ms */
    rungc_clear zrn_clear;     /* signal of ZRN */
    rungc_home home;           /* DSZR */
    rungc_interrupt interrupt; /* DVIT */
} rungc_wiring;

/* The pulse outputs of a family of models. */
typedef struct rungc_pulse_family {
    const rungc_wiring *outputs; /* Y000 first */
    uint32_t count;
    uint32_t lowest_hz;        /* lowest speed of PLSY */
    uint32_t highest_hz;       /* highest speed */
    uint32_t fewest_with_ramps; /* the fewest pulses that PLSR sends */
    uint16_t conflict;         /* code of an instruction for an output that another one uses */
    bool raises_speeds;        /* DRVI and DRVA raise a speed that ramps cannot begin with */
} rungc_pulse_family;

/* The family of a program; in rungc_wiring.c. */
const rungc_pulse_family *rungc_pulse_family_of(rungc_pulses family);

#endif
