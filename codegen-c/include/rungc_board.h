/*
 * rungc_board.h: a board, described once. NAME_poll of a program's NAME_board.h does all wiring between it and the program.
 *
 * Types only: a program that does not call the runtime library needs nothing to be linked. Times are microseconds by the board's
 * clock, which may begin anywhere and wraps after 71 minutes; characters carry times by the same clock. Inputs and outputs have plain numbers: 8 is X010.
 */
#ifndef RUNGC_BOARD_H
#define RUNGC_BOARD_H

#include "rungc_rt.h"

/* A change of an input. */
typedef struct rungc_edge {
    uint16_t input; /* the input X */
    bool on;        /* true for a rising edge */
} rungc_edge;

/* Capacity of a queue of edges, plus one. */
#ifndef RUNGC_EDGES
#define RUNGC_EDGES 64u
#endif

/* A queue of edges between one interrupt and NAME_poll, on one core. All zero is an empty one. */
typedef struct rungc_edges {
    volatile uint16_t slots[RUNGC_EDGES]; /* an input's number, and in the lowest bit whether it turned on */
    volatile uint16_t first;              /* index of the oldest edge; written by the main loop */
    volatile uint16_t end;                /* index for the next one; written by the interrupt */
    volatile uint16_t lost;               /* edges lost, wrapping; written by the interrupt */
} rungc_edges;

/* Notes an edge, in the interrupt; of an input below 32768. Returns false if the queue is full and the edge is lost. */
static inline bool rungc_note_edge(rungc_edges *edges, uint16_t input, bool on)
{
    const uint16_t end = edges->end;
    const uint16_t next = (uint16_t)((end + 1u) % RUNGC_EDGES);

    if (next == edges->first) {
        edges->lost = (uint16_t)(edges->lost + 1u);
        return false;
    }
    edges->slots[end] = (uint16_t)(((unsigned)input << 1) | (on ? 1u : 0u));
    edges->end = next;
    return true;
}

/* Takes the oldest edge, in the board's `next_edge`; false if there is none. */
static inline bool rungc_take_edge(rungc_edges *edges, rungc_edge *edge)
{
    const uint16_t first = edges->first;

    if (first == edges->end) {
        return false;
    }
    edge->input = (uint16_t)(edges->slots[first] >> 1);
    edge->on = (edges->slots[first] & 1u) != 0u;
    edges->first = (uint16_t)((first + 1u) % RUNGC_EDGES);
    return true;
}

/* Capacity of a queue of characters, plus one. */
#ifndef RUNGC_CHARACTERS
#define RUNGC_CHARACTERS 64u
#endif

/* A queue of characters between the interrupt of a UART and the board's `receive`, on one core. All zero is an empty one. The main loop
   must take each character within a second. */
typedef struct rungc_characters {
    volatile uint32_t slots[RUNGC_CHARACTERS]; /* from the lowest bit: 8 of value, 3 of fault, 21 of time */
    volatile uint16_t first;                   /* index of the oldest character; written by the main loop */
    volatile uint16_t end;                     /* index for the next one; written by the interrupt */
    volatile bool lost;                        /* a character found no room, and none came after it; the interrupt's */
} rungc_characters;

/* Notes a character that is in at `now_us`, in the interrupt. One that finds no room is lost: false says so, and the next one has the
   fault RUNGC_CHAR_FAULT_OVERRUN. */
static inline bool rungc_note_character(rungc_characters *characters, uint32_t now_us, uint8_t byte, rungc_char_fault fault)
{
    const uint16_t end = characters->end;
    const uint16_t next = (uint16_t)((end + 1u) % RUNGC_CHARACTERS);

    if (next == characters->first) {
        characters->lost = true;
        return false;
    }
    if (characters->lost && (fault == RUNGC_CHAR_FAULT_NONE)) {
        fault = RUNGC_CHAR_FAULT_OVERRUN;
    }
    characters->lost = false;
    characters->slots[end] = (now_us << 11) | ((uint32_t)fault << 8) | byte;
    characters->end = next;
    return true;
}

/* Takes the oldest character that was in by `now_us`, in the board's `receive`; false if there is none. */
static inline bool rungc_take_character(rungc_characters *characters, uint32_t now_us, rungc_received *character)
{
    const uint16_t first = characters->first;
    const uint32_t slot = characters->slots[first];
    const uint32_t age_us = (now_us - (slot >> 11)) & 0x1FFFFFu;

    if (first == characters->end || age_us > 0xFFFFFu) {
        return false;
    }
    character->at_us = now_us - age_us;
    character->byte = (uint8_t)slot;
    character->fault = (rungc_char_fault)((slot >> 8) & 7u);
    characters->first = (uint16_t)((first + 1u) % RUNGC_CHARACTERS);
    return true;
}

/* Counts of a hardware counter: pulses of one input, or quarters of an encoder's cycle. */
typedef struct rungc_count {
    uint16_t input;   /* the input X; of an encoder that of phase A */
    uint16_t phase_b; /* of an encoder: the input X of phase B; of pulses: as `input` */
    uint32_t from;    /* of an encoder: the timer at the last call. Its two lowest bits are the phases: 0 both off, 1 A on,
                         2 both on, 3 B on */
    int32_t count;    /* number since then; of an encoder those in which B leads are negative */
} rungc_count;

/* A board. What it lacks is NULL; only `now_us` has to be there. `hal.context` is handed to each function. */
typedef struct rungc_board {
    /* Pins and what instructions ask: `input` is called before each scan, `set_output` after it, and after edges and counts. The main loop
       calls all of them, with one exception: NAME_on_timer calls `set_output`, for pulse outputs alone. In the timer's interrupt that is while
       the main loop sets others, so pins of one register of the microcontroller are set and reset by single writes. `hold_pulses` keeps
       that interrupt from coming, or lets it come again; it is not nested. */
    rungc_hal hal;

    /* Time: microseconds by a clock that may begin anywhere, wrapping. Their resolution is that of everything else. A reading that is up to
       a second before an earlier one has no effect. With `wake_in` it is also called in the timer's interrupt. */
    uint32_t (*now_us)(void *context);

    /* Edges: an interrupt notes each in a queue, see rungc_note_edge. Gives the oldest one that was not taken yet; false if there is none. */
    bool (*next_edge)(void *context, rungc_edge *edge);

    /* Counters, for rates at which an interrupt for each edge is too slow. Gives the counts of this one since the last call, which may
       be nothing; false after the last one, they are numbered from 0. The program gets it as that many edges, so its comparisons act
       at the count. */
    bool (*counted)(void *context, unsigned counter, rungc_count *count);

    /* Pulses: arms the timer whose interrupt calls NAME_on_timer, to fire in this many microseconds; 0: as soon as it can, UINT32_MAX: not at
       all. Without it pulses are as exact as NAME_poll is called often. */
    void (*wake_in)(void *context, uint32_t us);

    /* Bit n: X n (0 to 31) follows edges and counts and not `hal.input`, so that the phases of an encoder stay in order. */
    uint32_t followed;

    /* Scan period, start to start, in microseconds, below 2^31; 0: a scan at each NAME_poll. */
    uint32_t period_us;

    /* Private. */
    uint32_t now_ms;      /* the board's clock in milliseconds: 1000 times it is the start of this one in microseconds */
    uint32_t next_scan;   /* start of the next scan */
    uint32_t scan_us;     /* duration of the last one */
    bool began;           /* NAME_poll was called */
} rungc_board;

/* The first poll: whether it is. */
static inline bool rungc_board_begins(rungc_board *board, uint32_t now_us)
{
    const bool first = !board->began;

    if (first) {
        board->began = true;
        board->now_ms = now_us / 1000u;
        board->next_scan = now_us;
    }
    return first;
}

/* A second of the board's clock. Readings in milliseconds that are RUNGC_TURN_MS apart are the same in microseconds. */
#define RUNGC_SECOND_US 1000000u
#define RUNGC_TURN_MS 0x20000000u

/* Advances time: true if another millisecond has begun, or the clock was set. */
static inline bool rungc_board_passes(rungc_board *board, uint32_t now_us)
{
    plc_stopwatch watch = {board->now_ms * 1000u, 0};
    const uint32_t last_us = watch.reading;
    const uint32_t passed = plc_stopwatch_advance(&watch, now_us, RUNGC_SECOND_US) / 1000u;

    if (last_us - now_us > RUNGC_SECOND_US && last_us - now_us <= UINT32_MAX / 2u + 1u) {
        /* The reading that is before this one, so that the program sees that the clock was set, too. */
        board->now_ms -= (board->now_ms - now_us / 1000u) % RUNGC_TURN_MS;
        board->next_scan = now_us;
        return true;
    }
    board->now_ms += passed;
    return passed != 0u;
}

/* The time between two readings; 0 if the second one is back. */
static inline uint32_t rungc_board_between(uint32_t begin_us, uint32_t end_us)
{
    plc_stopwatch watch = {begin_us, 0};

    return plc_stopwatch_advance(&watch, end_us, RUNGC_SECOND_US);
}

/* Returns true if a scan is due. Missed scans are skipped. */
static inline bool rungc_board_scans(rungc_board *board, uint32_t now_us)
{
    const uint32_t late = now_us - board->next_scan;

    if (late > UINT32_MAX / 2u) {
        return false;
    }
    board->next_scan = ((late < board->period_us) ? board->next_scan : now_us) + board->period_us;
    return true;
}

/* After a scan: if the program asks for scans of constant length (`constant_us` is not 0), the next one begins that long after the start of
   this one, or at once if this one took longer. */
static inline void rungc_board_waits(rungc_board *board, uint32_t constant_us)
{
    if (constant_us != 0u && board->scan_us <= constant_us) {
        board->next_scan += constant_us - board->period_us;
        board->scan_us = constant_us;
    } else if (constant_us != 0u) {
        board->next_scan = board->now_us(board->hal.context);
    }
}

/* Keeps the timer's interrupt from coming, or lets it come again. */
static inline void rungc_board_hold(const rungc_board *board, bool hold)
{
    if (board->hal.hold_pulses != NULL) {
        board->hal.hold_pulses(board->hal.context, hold);
    }
}

/* Phases of an encoder in a quarter of its cycle. */
static inline bool rungc_phase_a(uint32_t quarter)
{
    return ((quarter + 1u) & 2u) != 0u;
}

static inline bool rungc_phase_b(uint32_t quarter)
{
    return (quarter & 2u) != 0u;
}

#endif
