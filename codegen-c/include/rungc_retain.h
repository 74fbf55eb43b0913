/*
 * rungc_retain.h: latched devices that survive power-off, saved to two slots of flash or to a file. NAME_retain.h of each program has the
 * functions to call; this is what they share.
 *
 * A record holds the values of all latched devices, with the program's name, a sequence number and a checksum; runtime-rt's
 * retain/record.rs has the format, which is the same in Rust. Record after record goes into one slot until that is full, then the other
 * slot is erased and takes the next. So power may fail at any time: the newest complete record is either the one being written or the
 * one before it. A part that allows N erasures takes N times 2 times rungc_saves_per_erasure() saves.
 */
#ifndef RUNGC_RETAIN_H
#define RUNGC_RETAIN_H

#include "rungc_access.h"

/* Two slots of flash, 0 and 1, each of which is erased as a whole: one or more of its pages or sectors. Functions return false if the
   operation failed. RAM that keeps its contents works likewise: it erases by writing 0xFF. */
typedef struct rungc_flash {
    void *context;        /* handed to each function */
    uint32_t slot_length; /* bytes of each slot, a multiple of `word_length` */
    uint32_t word_length; /* bytes that flash writes at once, a power of 2 up to RUNGC_WORD_MAX; 0 stands for up to 8 */
    bool (*read)(void *context, unsigned slot, uint32_t offset, void *bytes, uint32_t length);
    bool (*erase)(void *context, unsigned slot); /* makes all bytes 0xFF */
    /* Writes bytes that are erased; offset and length are multiples of `word_length`, and of 8. */
    bool (*program)(void *context, unsigned slot, uint32_t offset, const void *bytes, uint32_t length);
} rungc_flash;

/* Latched devices of consecutive numbers. */
typedef struct rungc_retained_run {
    uint8_t device; /* their plc_class */
    uint16_t first; /* first number */
    uint16_t count; /* number of devices */
} rungc_retained_run;

/* A latched timer or counter that RST may hold at 0 over power-off, and the bool in the program's struct that says so. */
typedef struct rungc_retained_reset {
    uint8_t device; /* its plc_class */
    uint16_t number;
    size_t offset;
} rungc_retained_reset;

/* Data that a program retains over power-off. */
typedef struct rungc_retained {
    const char *program; /* its name and model: records of another program are not loaded */
    const rungc_retained_run *runs;
    size_t run_count;
    const rungc_retained_reset *resets; /* NULL: there are none */
    size_t reset_count;
    bool contacts;       /* true if contacts of timers and counters are retained with their values */
    uint16_t key_number; /* models with a latch key: the register D that has to hold it, or nothing is retained; else 0 */
    int16_t key;
    bool (*read)(const void *plc, plc_class device, uint32_t number, int32_t *value);
    bool (*write)(void *plc, plc_class device, uint32_t number, int32_t value);
} rungc_retained;

/* Result of loading. */
typedef enum rungc_loaded {
    RUNGC_LOADED_NOTHING, /* nothing was saved yet */
    RUNGC_LOADED_FOREIGN, /* the saved devices are those of another program: none was loaded */
    RUNGC_LOADED_DEVICES, /* latched devices have their values again */
    RUNGC_LOADED_FAILED   /* their memory cannot be read */
} rungc_loaded;

/* Bytes of a record in turn, and bytes of what holds one. */
typedef struct rungc_sink {
    bool (*put)(void *context, const uint8_t *bytes, uint32_t length);
    void *context;
} rungc_sink;

typedef struct rungc_source {
    bool (*read)(void *context, uint32_t offset, void *bytes, uint32_t length);
    void *context;
} rungc_source;

/* The longest name of a program in a record, in bytes. */
#define RUNGC_OWNER_MAX 47u

/* A complete record. */
typedef struct rungc_record {
    uint32_t at;       /* its offset */
    uint32_t length;   /* in bytes */
    uint32_t sequence; /* its number */
    uint16_t runs;
    char owner[RUNGC_OWNER_MAX + 1u]; /* the program that it belongs to */
} rungc_record;

enum {
    RUNGC_RECORD_HEADER = 15,
    RUNGC_RECORD_RUN = 5,
    RUNGC_RECORD_CHECKSUM = 4
};

/* The longest word of flash, and the shortest distance of records; they begin at multiples of the word, or of that. */
#define RUNGC_WORD_MAX 32u
#define RUNGC_WORD_MIN 8u

/* Bits of the states of a timer or counter in a record. */
#define RUNGC_STATE_CONTACT 1u
#define RUNGC_STATE_RESET 2u

/* Form of a device in a record. */
typedef enum rungc_form {
    RUNGC_FORM_BIT,
    RUNGC_FORM_WORD,
    RUNGC_FORM_SHORT, /* a value of two bytes, and a byte of states */
    RUNGC_FORM_LONG   /* a value of four bytes, and a byte of states */
} rungc_form;

static inline rungc_form rungc_form_of(uint8_t device, uint32_t number)
{
    rungc_form form = RUNGC_FORM_WORD;

    if (device <= (uint8_t)PLC_CLASS_S) {
        form = RUNGC_FORM_BIT;
    } else if ((device == (uint8_t)PLC_CLASS_C) && (number >= 200u)) {
        form = RUNGC_FORM_LONG;
    } else if ((device == (uint8_t)PLC_CLASS_T) || (device == (uint8_t)PLC_CLASS_C)) {
        form = RUNGC_FORM_SHORT;
    } else {
        /* A register. */
    }
    return form;
}

/* Bytes of `count` devices. */
static inline uint32_t rungc_form_bytes(rungc_form form, uint32_t count)
{
    static const uint8_t sizes[] = {0, 2, 3, 5};

    return (form == RUNGC_FORM_BIT) ? ((count + 7u) / 8u) : (count * sizes[form]);
}

/* CRC-32 by half bytes; it begins with UINT32_MAX and ends inverted. */
static inline uint32_t rungc_record_crc(uint32_t crc, const uint8_t *bytes, uint32_t length)
{
    static const uint32_t table[16] = {0x00000000u, 0x1DB71064u, 0x3B6E20C8u, 0x26D930ACu, 0x76DC4190u, 0x6B6B51F4u,
                                       0x4DB26158u, 0x5005713Cu, 0xEDB88320u, 0xF00F9344u, 0xD6D6A3E8u, 0xCB61B38Cu,
                                       0x9B64C2B0u, 0x86D3D2D4u, 0xA00AE278u, 0xBDBDF21Cu};

    for (uint32_t i = 0; i < length; i++) {
        crc ^= bytes[i];
        crc = (crc >> 4) ^ table[crc & 15u];
        crc = (crc >> 4) ^ table[crc & 15u];
    }
    return crc;
}

static inline uint32_t rungc_name_length(const rungc_retained *retained)
{
    const size_t length = strlen(retained->program);

    return (length < RUNGC_OWNER_MAX) ? (uint32_t)length : RUNGC_OWNER_MAX;
}

/* Length of a record, in bytes. */
static inline uint32_t rungc_record_length(const rungc_retained *retained)
{
    uint32_t length = (uint32_t)RUNGC_RECORD_HEADER + rungc_name_length(retained) + (uint32_t)RUNGC_RECORD_CHECKSUM;

    for (size_t i = 0; i < retained->run_count; i++) {
        const rungc_retained_run *const run = &retained->runs[i];

        length += (uint32_t)RUNGC_RECORD_RUN + rungc_form_bytes(rungc_form_of(run->device, run->first), run->count);
    }
    return length;
}

/* Records begin at multiples of this. */
static inline uint32_t rungc_record_align(const rungc_flash *flash)
{
    return (flash->word_length > RUNGC_WORD_MIN) ? flash->word_length : RUNGC_WORD_MIN;
}

static inline uint32_t rungc_aligned(const rungc_flash *flash, uint32_t length)
{
    const uint32_t align = rungc_record_align(flash);

    return (length + align - 1u) / align * align;
}

/* Returns true if all bytes are erased. */
static inline bool rungc_is_erased(const uint8_t *bytes, uint32_t length)
{
    bool erased = true;

    for (uint32_t i = 0; (i < length) && erased; i++) {
        erased = bytes[i] == 0xFFu;
    }
    return erased;
}

static inline void rungc_number_bytes(uint8_t *bytes, uint32_t value, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        bytes[i] = (uint8_t)(value >> (8u * i));
    }
}

static inline uint32_t rungc_record_number(const uint8_t *bytes, unsigned count)
{
    uint32_t value = 0;

    for (unsigned i = 0; i < count; i++) {
        value |= (uint32_t)bytes[i] << (8u * i);
    }
    return value;
}

static inline int32_t rungc_read_retained(const rungc_retained *retained, const void *plc, plc_class device, uint32_t number)
{
    int32_t value = 0;

    (void)retained->read(plc, device, number, &value);
    return value;
}

/* The class of the contacts of timers or counters. */
static inline plc_class rungc_contacts(uint8_t device)
{
    return (device == (uint8_t)PLC_CLASS_T) ? PLC_CLASS_TS : PLC_CLASS_CS;
}

/* The reset state of a timer or counter in the program's struct, as an offset; NULL if it is not retained. */
static inline const size_t *rungc_reset_offset(const rungc_retained *retained, uint8_t device, uint32_t number)
{
    const size_t *offset = NULL;

    for (size_t i = 0; (i < retained->reset_count) && (offset == NULL); i++) {
        if ((retained->resets[i].device == device) && (retained->resets[i].number == number)) {
            offset = &retained->resets[i].offset;
        }
    }
    return offset;
}

/* The states of a timer or counter, as in a record. */
static inline uint8_t rungc_states(const rungc_retained *retained, const void *plc, uint8_t device, uint32_t number)
{
    const size_t *const offset = rungc_reset_offset(retained, device, number);
    unsigned states = 0;

    if (retained->contacts && (rungc_read_retained(retained, plc, rungc_contacts(device), number) != 0)) {
        states |= RUNGC_STATE_CONTACT;
    }
    if ((offset != NULL) && *(const bool *)((const char *)plc + *offset)) {
        states |= RUNGC_STATE_RESET;
    }
    return (uint8_t)states;
}

static inline void rungc_restore_states(const rungc_retained *retained, void *plc, uint8_t device, uint32_t number, uint8_t states)
{
    const size_t *const offset = rungc_reset_offset(retained, device, number);
    const bool contact = retained->contacts && ((states & RUNGC_STATE_CONTACT) != 0u);

    (void)retained->write(plc, rungc_contacts(device), number, contact ? 1 : 0);
    if (offset != NULL) {
        *(bool *)((char *)plc + *offset) = (states & RUNGC_STATE_RESET) != 0u;
    }
}

/* Writes the values of a program's latched devices. On models with a latch key they are 0 without it. */
static inline bool rungc_put_values(const rungc_retained *retained, const void *plc, const rungc_sink *sink)
{
    const bool valid =
        (retained->key_number == 0u) || (rungc_read_retained(retained, plc, PLC_CLASS_D, retained->key_number) == retained->key);
    bool done = true;

    for (size_t i = 0; (i < retained->run_count) && done; i++) {
        const rungc_retained_run *const run = &retained->runs[i];
        const rungc_form form = rungc_form_of(run->device, run->first);
        const plc_class device = (plc_class)run->device;
        const uint32_t step = (form == RUNGC_FORM_BIT) ? 8u : 1u;

        for (uint32_t n = 0; (n < run->count) && done; n += step) {
            const uint32_t number = run->first + n;
            const uint32_t length = rungc_form_bytes(form, 1u);
            uint8_t bytes[5] = {0};

            if (!valid) {
                /* All are 0. */
            } else if (form == RUNGC_FORM_BIT) {
                for (uint32_t bit = 0; (bit < 8u) && ((n + bit) < run->count); bit++) {
                    const bool on = rungc_read_retained(retained, plc, device, number + bit) != 0;

                    bytes[0] = (uint8_t)(bytes[0] | (on ? (1u << bit) : 0u));
                }
            } else {
                const uint32_t value = (uint32_t)rungc_read_retained(retained, plc, device, number);

                rungc_number_bytes(bytes, value, (form == RUNGC_FORM_LONG) ? 4u : 2u);
                if (form != RUNGC_FORM_WORD) {
                    bytes[length - 1u] = rungc_states(retained, plc, run->device, number);
                }
            }
            done = sink->put(sink->context, bytes, length);
        }
    }
    return done;
}

/* Counts what passes on its way. */
typedef struct rungc_summing {
    const rungc_sink *sink; /* NULL: nowhere */
    uint32_t crc;
} rungc_summing;

static inline bool rungc_put_summed(void *context, const uint8_t *bytes, uint32_t length)
{
    rungc_summing *const summing = (rungc_summing *)context;

    summing->crc = rungc_record_crc(summing->crc, bytes, length);
    return (summing->sink == NULL) || summing->sink->put(summing->sink->context, bytes, length);
}

/* A checksum of the values alone: whether something has changed. */
static inline uint32_t rungc_retained_state(const rungc_retained *retained, const void *plc)
{
    rungc_summing summing = {NULL, UINT32_MAX};
    const rungc_sink sink = {rungc_put_summed, &summing};

    (void)rungc_put_values(retained, plc, &sink);
    return ~summing.crc;
}

/* Writes a record. */
static inline bool rungc_put_record(const rungc_retained *retained, const void *plc, uint32_t sequence, const rungc_sink *to)
{
    rungc_summing summing = {to, UINT32_MAX};
    const rungc_sink sink = {rungc_put_summed, &summing};
    const uint32_t name = rungc_name_length(retained);
    uint8_t bytes[RUNGC_RECORD_HEADER] = {'R', 'G', 'R', '1'};
    bool done;

    rungc_number_bytes(&bytes[4], sequence, 4);
    rungc_number_bytes(&bytes[8], rungc_record_length(retained), 4);
    rungc_number_bytes(&bytes[12], (uint32_t)retained->run_count, 2);
    bytes[14] = (uint8_t)name;
    done = rungc_put_summed(&summing, bytes, (uint32_t)RUNGC_RECORD_HEADER) &&
           rungc_put_summed(&summing, (const uint8_t *)retained->program, name);
    for (size_t i = 0; (i < retained->run_count) && done; i++) {
        bytes[0] = retained->runs[i].device;
        rungc_number_bytes(&bytes[1], retained->runs[i].first, 2);
        rungc_number_bytes(&bytes[3], retained->runs[i].count, 2);
        done = rungc_put_summed(&summing, bytes, (uint32_t)RUNGC_RECORD_RUN);
    }
    done = done && rungc_put_values(retained, plc, &sink);
    rungc_number_bytes(bytes, ~summing.crc, 4);
    return done && to->put(to->context, bytes, (uint32_t)RUNGC_RECORD_CHECKSUM);
}

/* Looks for a complete record that begins at an offset of something that is `end` bytes long; `length` 0 if there is none. False if it
   cannot be read. */
static inline bool rungc_find_record(const rungc_source *source, uint32_t at, uint32_t end, rungc_record *record)
{
    uint8_t bytes[64];
    uint32_t crc = UINT32_MAX;
    uint32_t checked;

    record->at = at;
    record->length = 0;
    if ((end - at) < (uint32_t)(RUNGC_RECORD_HEADER + RUNGC_RECORD_CHECKSUM)) {
        return true;
    }
    if (!source->read(source->context, at, bytes, (uint32_t)RUNGC_RECORD_HEADER)) {
        return false;
    }
    const uint32_t length = rungc_record_number(&bytes[8], 4);
    const uint32_t name = bytes[14];
    record->sequence = rungc_record_number(&bytes[4], 4);
    record->runs = (uint16_t)rungc_record_number(&bytes[12], 2);
    checked = (uint32_t)RUNGC_RECORD_HEADER + name + ((uint32_t)RUNGC_RECORD_RUN * record->runs);
    if ((memcmp(bytes, "RGR1", 4) != 0) || (name > RUNGC_OWNER_MAX) || (length < (checked + (uint32_t)RUNGC_RECORD_CHECKSUM)) ||
        (length > (end - at))) {
        return true;
    }
    if (!source->read(source->context, at + (uint32_t)RUNGC_RECORD_HEADER, record->owner, name)) {
        return false;
    }
    record->owner[name] = '\0';
    checked = length - (uint32_t)RUNGC_RECORD_CHECKSUM;
    for (uint32_t from = 0; from < checked; from += (uint32_t)sizeof bytes) {
        const uint32_t left = checked - from;
        const uint32_t piece = (left < (uint32_t)sizeof bytes) ? left : (uint32_t)sizeof bytes;

        if (!source->read(source->context, at + from, bytes, piece)) {
            return false;
        }
        crc = rungc_record_crc(crc, bytes, piece);
    }
    if (!source->read(source->context, at + checked, bytes, (uint32_t)RUNGC_RECORD_CHECKSUM)) {
        return false;
    }
    if (rungc_record_number(bytes, 4) == ~crc) {
        record->length = length;
    }
    return true;
}

static inline bool rungc_is_retained(const rungc_retained *retained, uint8_t device, uint32_t number)
{
    bool found = false;

    for (size_t i = 0; (i < retained->run_count) && !found; i++) {
        const rungc_retained_run *const run = &retained->runs[i];

        found = (run->device == device) && (number >= run->first) && ((number - run->first) < run->count);
    }
    return found;
}

/* Gives the `n`-th device of a run its value. */
static inline bool rungc_restore_device(const rungc_retained *retained, void *plc, const rungc_source *source,
                                        const rungc_retained_run *run, uint32_t values, uint32_t n)
{
    const rungc_form form = rungc_form_of(run->device, run->first);
    const uint32_t at = (form == RUNGC_FORM_BIT) ? (n / 8u) : rungc_form_bytes(form, n);
    const uint32_t length = rungc_form_bytes(form, 1u);
    const plc_class device = (plc_class)run->device;
    const uint32_t number = run->first + n;
    uint8_t bytes[5];

    if (!source->read(source->context, values + at, bytes, length)) {
        return false;
    }
    if (form == RUNGC_FORM_BIT) {
        (void)retained->write(plc, device, number, (int32_t)((unsigned)(bytes[0] >> (n % 8u)) & 1u));
    } else if (form == RUNGC_FORM_LONG) {
        (void)retained->write(plc, device, number, (int32_t)rungc_record_number(bytes, 4));
    } else {
        (void)retained->write(plc, device, number, (int16_t)rungc_record_number(bytes, 2));
    }
    if ((form == RUNGC_FORM_SHORT) || (form == RUNGC_FORM_LONG)) {
        rungc_restore_states(retained, plc, run->device, number, bytes[length - 1u]);
    }
    return true;
}

/* Gives a program the values of a record, if it is one of this program. `dropped`: how many devices of the record it does not keep. */
static inline rungc_loaded rungc_restore(const rungc_retained *retained, void *plc, const rungc_source *source,
                                         const rungc_record *record, uint32_t *dropped)
{
    const uint32_t name = rungc_name_length(retained);
    const uint32_t table = record->at + (uint32_t)RUNGC_RECORD_HEADER + (uint32_t)strlen(record->owner);
    uint32_t values = table + ((uint32_t)RUNGC_RECORD_RUN * record->runs);
    bool done = true;

    *dropped = 0;
    if ((strlen(record->owner) != name) || (strncmp(record->owner, retained->program, name) != 0)) {
        return RUNGC_LOADED_FOREIGN;
    }
    for (uint32_t i = 0; (i < record->runs) && done; i++) {
        uint8_t bytes[RUNGC_RECORD_RUN];

        done = source->read(source->context, table + ((uint32_t)RUNGC_RECORD_RUN * i), bytes, (uint32_t)RUNGC_RECORD_RUN);
        if (done) {
            const rungc_retained_run run = {bytes[0], (uint16_t)rungc_record_number(&bytes[1], 2), (uint16_t)rungc_record_number(&bytes[3], 2)};

            for (uint32_t n = 0; (n < run.count) && done; n++) {
                if (rungc_is_retained(retained, run.device, run.first + n)) {
                    done = rungc_restore_device(retained, plc, source, &run, values, n);
                } else {
                    (*dropped)++;
                }
            }
            values += rungc_form_bytes(rungc_form_of(run.device, run.first), run.count);
        }
    }
    return done ? RUNGC_LOADED_DEVICES : RUNGC_LOADED_FAILED;
}

/* Saves a program's latched devices to two slots of flash, and loads them. `flash` is the caller's; the rest begins with 0. */
typedef struct rungc_slots {
    const rungc_flash *flash;

    /* Private. */
    rungc_record newest; /* length 0: there is none */
    unsigned newest_slot;
    bool has_next; /* true if the next record goes to next_slot at next_at; the slot is erased from there on */
    unsigned next_slot;
    uint32_t next_at;
    bool has_saved; /* true if `saved` is the checksum of the last saved or loaded record */
    uint32_t saved;
    uint32_t looked_ms;
} rungc_slots;

/* One slot as a source. */
typedef struct rungc_slot {
    const rungc_flash *flash;
    unsigned slot;
} rungc_slot;

static inline bool rungc_read_slot(void *context, uint32_t offset, void *bytes, uint32_t length)
{
    const rungc_slot *const of = (const rungc_slot *)context;

    return of->flash->read(of->flash->context, of->slot, offset, bytes, length);
}

/* Looks through a slot for its last complete record, and for where all bytes are erased from. */
static inline bool rungc_scan_slot(rungc_slots *slots, unsigned slot)
{
    const uint32_t align = rungc_record_align(slots->flash);
    const uint32_t end = slots->flash->slot_length;
    rungc_slot of = {slots->flash, slot};
    const rungc_source source = {rungc_read_slot, &of};
    rungc_record last = {0};
    uint32_t free_at = 0;
    uint32_t at = 0;

    while ((end - at) >= align) {
        uint8_t bytes[RUNGC_WORD_MAX];
        rungc_record record = {0};
        uint32_t step = align;

        if (!rungc_read_slot(&of, at, bytes, align)) {
            return false;
        }
        if (!rungc_is_erased(bytes, align)) {
            if (!rungc_find_record(&source, at, end, &record)) {
                return false;
            }
            if (record.length != 0u) {
                last = record;
                step = rungc_aligned(slots->flash, record.length);
            }
            free_at = at + step;
        }
        at = (step < (end - at)) ? (at + step) : end;
    }
    if ((last.length != 0u) && ((slots->newest.length == 0u) || ((int32_t)(last.sequence - slots->newest.sequence) > 0))) {
        slots->newest = last;
        slots->newest_slot = slot;
        slots->has_next = true;
        slots->next_slot = slot;
        slots->next_at = free_at;
    }
    return true;
}

/* Gives a program that was just initialised the values of the newest record. */
static inline rungc_loaded rungc_load(rungc_slots *slots, const rungc_retained *retained, void *plc)
{
    rungc_loaded loaded = RUNGC_LOADED_NOTHING;
    uint32_t dropped = 0;

    slots->newest.length = 0;
    slots->has_next = false;
    if (!rungc_scan_slot(slots, 0) || !rungc_scan_slot(slots, 1)) {
        loaded = RUNGC_LOADED_FAILED;
    } else if (slots->newest.length != 0u) {
        rungc_slot of = {slots->flash, slots->newest_slot};
        const rungc_source source = {rungc_read_slot, &of};

        loaded = rungc_restore(retained, plc, &source, &slots->newest, &dropped);
    } else {
        /* Nothing was saved yet. */
    }
    slots->has_saved = loaded == RUNGC_LOADED_DEVICES;
    if (slots->has_saved) {
        slots->saved = rungc_retained_state(retained, plc);
    }
    return loaded;
}

/* Makes room for the next record, so that rungc_save does not have to erase. False if flash cannot be erased, a slot is shorter than a
   record, or a word is too long. */
static inline bool rungc_prepare(rungc_slots *slots, const rungc_retained *retained)
{
    const uint32_t length = rungc_aligned(slots->flash, rungc_record_length(retained));
    const uint32_t end = slots->flash->slot_length;
    const bool has_room = slots->has_next && (slots->next_at <= end) && ((end - slots->next_at) >= length);

    if (!has_room && (length <= end)) {
        const unsigned slot = (slots->newest.length != 0u) ? (1u - slots->newest_slot) : 0u;

        slots->has_next = slots->flash->erase(slots->flash->context, slot);
        slots->next_slot = slot;
        slots->next_at = 0;
    }
    return (length <= end) && (rungc_record_align(slots->flash) <= RUNGC_WORD_MAX) && slots->has_next;
}

/* Gathers bytes to pieces that flash takes. */
typedef struct rungc_slot_writer {
    const rungc_slots *slots;
    uint32_t at;
    uint32_t used;
    uint8_t bytes[RUNGC_WORD_MAX];
} rungc_slot_writer;

static inline bool rungc_flush_slot(rungc_slot_writer *writer)
{
    const rungc_flash *const flash = writer->slots->flash;
    const uint32_t align = rungc_record_align(flash);
    const bool done = flash->program(flash->context, writer->slots->next_slot, writer->at, writer->bytes, align);

    writer->at += align;
    writer->used = 0;
    (void)memset(writer->bytes, 0xFF, sizeof writer->bytes);
    return done;
}

static inline bool rungc_put_slot(void *context, const uint8_t *bytes, uint32_t length)
{
    rungc_slot_writer *const writer = (rungc_slot_writer *)context;
    bool done = true;

    for (uint32_t i = 0; (i < length) && done; i++) {
        writer->bytes[writer->used] = bytes[i];
        writer->used++;
        if (writer->used == rungc_record_align(writer->slots->flash)) {
            done = rungc_flush_slot(writer);
        }
    }
    return done;
}

/* Saves a program's latched devices now, as when a supply says that power is about to fail. Unless rungc_prepare or rungc_save_changes was
   called before, this may have to erase a slot first. False if flash cannot be written or a slot is shorter than a record. */
static inline bool rungc_save(rungc_slots *slots, const rungc_retained *retained, const void *plc)
{
    const uint32_t sequence = (slots->newest.length != 0u) ? (slots->newest.sequence + 1u) : 0u;
    bool done = rungc_prepare(slots, retained);

    if (done) {
        rungc_slot of = {slots->flash, slots->next_slot};
        const rungc_source source = {rungc_read_slot, &of};
        const uint32_t at = slots->next_at;
        rungc_slot_writer writer = {slots, at, 0, {0}};
        const rungc_sink sink = {rungc_put_slot, &writer};
        rungc_record written = {0};

        (void)memset(writer.bytes, 0xFF, sizeof writer.bytes);
        done = rungc_put_record(retained, plc, sequence, &sink);
        if (done && (writer.used != 0u)) {
            done = rungc_flush_slot(&writer);
        }
        /* A failed write leaves a part of a record. */
        slots->next_at = at + rungc_aligned(slots->flash, rungc_record_length(retained));
        done = done && rungc_find_record(&source, at, slots->flash->slot_length, &written) && (written.length != 0u) &&
               (written.sequence == sequence);
        if (done) {
            slots->newest = written;
            slots->newest_slot = of.slot;
            slots->saved = rungc_retained_state(retained, plc);
            slots->has_saved = true;
        }
    }
    return done;
}

/* To be called between scans; `now_ms` is the program's time. Once in `every_ms` saves latched devices if one has changed, and makes room
   for the next record. False as rungc_save. */
static inline bool rungc_save_changes(rungc_slots *slots, const rungc_retained *retained, const void *plc, uint32_t now_ms,
                                      uint32_t every_ms)
{
    bool done = true;

    if ((now_ms - slots->looked_ms) >= every_ms) {
        slots->looked_ms = now_ms;
        if (!slots->has_saved || (slots->saved != rungc_retained_state(retained, plc))) {
            done = rungc_save(slots, retained, plc) && rungc_prepare(slots, retained);
        }
    }
    return done;
}

/* Number of records that a slot takes between two erasures. */
static inline uint32_t rungc_saves_per_erasure(const rungc_flash *flash, const rungc_retained *retained)
{
    return flash->slot_length / rungc_aligned(flash, rungc_record_length(retained));
}

#endif
