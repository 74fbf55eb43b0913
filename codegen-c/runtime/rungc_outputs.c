/*
 * rungc_outputs.c: pulse outputs: time, counts and pins, and what instructions for them have in common.
 */
#include "rungc_outputs.h"

/* How far an instruction is. */
enum {
    PHASE_IDLE = 0,  /* it has not begun, was stopped, or had the output taken from it */
    PHASE_SENDS = 1, /* it sends */
    PHASE_DONE = 2,  /* it is done */
    PHASE_BEGINS = 3 /* it is to begin; its operands may keep it from that */
};

/* What an instruction does in a scan. */
typedef enum turn {
    TURN_REST,    /* nothing */
    TURN_START,   /* it begins */
    TURN_SENDS,   /* it sends */
    TURN_RELEASED /* it sent, and its drive has gone off */
} turn;

/* Registers of HM: places among those of an axis, and the pair with the pulses of Y000. */
enum { AXIS_POSITION = 18, AXIS_INCREMENT = 22, D_OUTPUT_PULSES = 80 };

rungc_axis *rungc_axis_of(const rungc_map *map, uint32_t output)
{
    const rungc_layout *const layout = map->layout;
    rungc_axis *const axes = rungc_part_at(map, layout->axes);

    for (size_t i = 0; i < layout->output_count; i++) {
        if (layout->outputs[i] == output) {
            return &axes[i];
        }
    }
    return NULL;
}

static const rungc_pulse_family *family_of(const rungc_map *map)
{
    return rungc_pulse_family_of(map->layout->pulses);
}

static void set_relays(const rungc_map *map, const uint16_t relays[2], bool on)
{
    rungc_set_relay(map, relays[0], on);
    rungc_set_relay(map, relays[1], on);
}

static bool any_is_on(const rungc_map *map, const uint16_t relays[2])
{
    return rungc_relay(map, relays[0]) || rungc_relay(map, relays[1]);
}

void rungc_show_pin(rungc_axis *axis)
{
    axis->on = axis->generator.busy && (rungc_generator_level(&axis->generator) != axis->inverted);
}

/* ---- Time ------------------------------------------------------------------------------------------------------------------------- */

/* Lets time pass, for a pin if there is one to be driven. This is all that an interrupt does. */
static void pass_time(rungc_axis *axis, uint32_t now_us, bool pin)
{
    rungc_generator *const generator = &axis->generator;
    const bool was_busy = generator->busy;
    const uint32_t count = pin ? rungc_generator_step(generator, now_us) : rungc_generator_advance(generator, now_us);

    axis->completed = axis->completed || (was_busy && rungc_generator_is_complete(generator));
    axis->uncounted = plc_int32((uint32_t)axis->uncounted + (generator->reverse ? (0u - count) : count));
    rungc_show_pin(axis);
}

uint32_t rungc_pulse_timer(rungc_map *map, uint32_t now_us)
{
    const uint32_t outputs = family_of(map)->count;
    uint32_t next = UINT32_MAX;
    uint32_t present = 0; /* the outputs that exist, and those that are on, a bit each: several axes may be bound to one */
    uint32_t shown = 0;

    for (uint32_t output = 0; output < outputs; output++) {
        rungc_axis *const axis = rungc_axis_of(map, output);

        if (axis == NULL) {
            continue;
        }
        if (!axis->timed) {
            axis->timed = true;
            axis->generator.now_us = now_us;
        }
        pass_time(axis, now_us, true);
        const uint32_t wait = rungc_generator_wait(&axis->generator, now_us);

        next = (wait < next) ? wait : next;
        present |= UINT32_C(1) << output;
        if (axis->on && (axis->output < 32u)) {
            shown |= UINT32_C(1) << axis->output;
        }
    }
    for (uint32_t output = 0; output < outputs; output++) {
        if ((((present >> output) & 1u) != 0u) && (map->hal != NULL) && (map->hal->set_output != NULL)) {
            map->hal->set_output(map->hal->context, (uint16_t)output, ((shown >> output) & 1u) != 0u);
        }
    }
    return next;
}

/* ---- Counts ----------------------------------------------------------------------------------------------------------------------- */

static void add_to(const rungc_map *map, uint32_t low, int32_t count)
{
    if (count != 0) {
        rungc_set_long_register(map, low, plc_add32(rungc_long_register(map, low), count));
    }
}

void rungc_count_pulses(const rungc_map *map, uint32_t output, const rungc_wiring *wiring)
{
    rungc_axis *const axis = rungc_axis_of(map, output);

    if (axis == NULL) {
        return;
    }
    const int32_t count = axis->uncounted;

    axis->uncounted = 0;
    if (wiring->axis == 0u) {
        axis->output = (uint16_t)output;
    }
    rungc_axis *const target = rungc_axis_of(map, axis->output);

    if (target != NULL) {
        target->sent = plc_add32(target->sent, count);
    }
    if (wiring->axis != 0u) {
        add_to(map, (uint32_t)wiring->axis + (uint32_t)AXIS_POSITION, count);
        add_to(map, (uint32_t)D_OUTPUT_PULSES + (2u * (uint32_t)axis->output), count);
        rungc_set_register(map, (uint32_t)wiring->axis + (uint32_t)AXIS_INCREMENT, plc_low(count));
    } else if (axis->counter != 0u) {
        add_to(map, axis->counter, count);
        if (wiring->sum != 0u) {
            add_to(map, wiring->sum, count);
        }
    } else {
        /* no one counts */
    }
}

/* Holds the interrupt off that sends pulses, or lets it come again. */
static void hold_pulses(const rungc_map *map, bool hold)
{
    if ((map->hal != NULL) && (map->hal->hold_pulses != NULL)) {
        map->hal->hold_pulses(map->hal->context, hold);
    }
}

/* Pulses end when the PLC goes to STOP, and while a stop relay is on; a signal of PWM only in STOP. */
static bool stops(const rungc_map *map, const rungc_wiring *wiring, const rungc_axis *axis)
{
    const plc_sys *const sys = rungc_sys(map);

    if (axis->generator.modulates && sys->running) {
        return false;
    }
    return !sys->running || sys->first_scan || any_is_on(map, wiring->stop);
}

static void count_until(const rungc_map *map, uint32_t now_us)
{
    const rungc_pulse_family *const family = family_of(map);

    for (uint32_t output = 0; output < family->count; output++) {
        const rungc_wiring *const wiring = &family->outputs[output];
        rungc_axis *const axis = rungc_axis_of(map, output);

        if (axis == NULL) {
            continue;
        }
        axis->inverted = axis->generator.modulates && rungc_relay(map, wiring->inverts);
        if (!axis->timed) {
            pass_time(axis, now_us, false);
        }
        axis->ended = axis->ended || axis->completed;
        axis->completed = false;
        if (stops(map, wiring, axis)) {
            rungc_generator_halt(&axis->generator);
            axis->owner = 0;
            rungc_show_pin(axis);
        }
        set_relays(map, wiring->busy, rungc_generator_millihertz(&axis->generator) > 0u);
        rungc_count_pulses(map, output, wiring);
    }
}

void rungc_advance_pulses(rungc_map *map, uint32_t now_us)
{
    hold_pulses(map, true);
    count_until(map, now_us);
    hold_pulses(map, false);
}

/* The largest number of pulses that any of the outputs sends by `now_us`. */
static uint32_t most_sent(const rungc_map *map, uint32_t now_us)
{
    const uint32_t outputs = family_of(map)->count;
    uint32_t most = 0;

    for (uint32_t output = 0; output < outputs; output++) {
        uint32_t sent = 0;

        /* Several axes may be bound to an output. */
        for (uint32_t i = 0; i < outputs; i++) {
            const rungc_axis *const axis = rungc_axis_of(map, i);

            if ((axis != NULL) && (axis->output == output)) {
                rungc_generator copy = axis->generator;
                const uint32_t count = rungc_generator_advance(&copy, now_us);

                sent = (count > (UINT32_MAX - sent)) ? UINT32_MAX : sent + count;
            }
        }
        most = (sent > most) ? sent : most;
    }
    return most;
}

uint32_t rungc_pass_pulses(rungc_map *map, uint32_t from_us, uint32_t until_us, uint32_t most)
{
    uint32_t shortest = 0;
    uint32_t longest = until_us - from_us;

    if (most_sent(map, until_us) >= most) {
        while ((longest - shortest) > 1u) {
            const uint32_t middle = shortest + ((longest - shortest) / 2u);

            if (most_sent(map, from_us + middle) >= most) {
                longest = middle;
            } else {
                shortest = middle;
            }
        }
    }
    count_until(map, from_us + longest);
    return from_us + longest;
}

int32_t rungc_pulses_sent(rungc_map *map, uint32_t number)
{
    const rungc_axis *const axis = rungc_axis_of(map, number);

    return (axis != NULL) ? axis->sent : 0;
}

uint32_t rungc_pulse_millihertz(rungc_map *map, uint32_t number)
{
    uint32_t sum = 0;

    for (uint32_t output = 0; output < family_of(map)->count; output++) {
        const rungc_axis *const axis = rungc_axis_of(map, output);

        if ((axis != NULL) && (axis->output == number)) {
            const uint32_t speed = rungc_generator_millihertz(&axis->generator);

            sum = (speed > (UINT32_MAX - sum)) ? UINT32_MAX : sum + speed;
        }
    }
    return sum;
}

/* ---- Instructions ----------------------------------------------------------------------------------------------------------------- */

static rungc_fault find_output(rungc_job *job, rungc_operand operand)
{
    if ((operand.value < 0) || ((uint32_t)operand.value >= job->family->count)) {
        return RUNGC_NO_DEVICE;
    }
    job->output = (uint32_t)operand.value;
    job->wiring = &job->family->outputs[job->output];
    job->axis = rungc_axis_of(job->call.map, job->output);
    return (job->axis != NULL) ? RUNGC_OK : RUNGC_NO_DEVICE;
}

void rungc_run_pulses(rungc_map *map, rungc_site site, const rungc_operand operands[], unsigned output, rungc_pulse_work *work)
{
    rungc_job job = {.family = family_of(map)};

    job.call = rungc_call_at(map, site);
    job.kept = rungc_kept(&job.call);
    /* A signal concerns an instruction only while it sends. */
    if (site.signal && ((job.kept[RUNGC_KEPT_DRIVE] == 0) || (job.kept[RUNGC_KEPT_PHASE] != PHASE_SENDS))) {
        return;
    }
    hold_pulses(map, true);
    rungc_fault fault = find_output(&job, operands[output]);
    if (fault == RUNGC_OK) {
        fault = work(&job, operands);
    }
    hold_pulses(map, false);
    rungc_conclude(&job.call, fault);
}

bool rungc_has_on(const rungc_job *job, uint16_t relay)
{
    return rungc_relay(job->call.map, relay);
}

uint32_t rungc_speed_of(const rungc_job *job, uint32_t hz)
{
    return 1000u * ((hz < job->family->highest_hz) ? hz : job->family->highest_hz);
}

/* What an instruction does in this scan, which itself says when it is done. */
static rungc_fault take_turn_resting(rungc_job *job, turn *taken)
{
    rungc_map *const map = job->call.map;
    const bool drive = job->call.site.drive;
    const bool was_driven = job->kept[RUNGC_KEPT_DRIVE] != 0;
    const bool restart = rungc_has_on(job, job->wiring->restart);
    const bool restarts = restart && (job->kept[RUNGC_KEPT_RESTART] == 0);
    const bool mine = job->axis->owner == job->call.site.slot;

    *taken = TURN_REST;
    job->kept[RUNGC_KEPT_DRIVE] = drive ? 1 : 0;
    job->kept[RUNGC_KEPT_RESTART] = restart ? 1 : 0;
    if (!drive) {
        if (was_driven && mine) {
            *taken = TURN_RELEASED;
        }
        return RUNGC_OK;
    }
    if (!was_driven || restarts || (job->kept[RUNGC_KEPT_PHASE] == PHASE_BEGINS)) {
        job->kept[RUNGC_KEPT_PHASE] = PHASE_IDLE;
        rungc_set_relay(map, RUNGC_M_COMPLETE, false);
        rungc_set_relay(map, job->wiring->aborted, false);
        if (any_is_on(map, job->wiring->stop)) {
            return RUNGC_OK;
        }
        if (job->axis->generator.busy && !restart) {
            return job->family->conflict;
        }
        job->kept[RUNGC_KEPT_PHASE] = PHASE_BEGINS;
        *taken = TURN_START;
    } else if (job->kept[RUNGC_KEPT_PHASE] == PHASE_SENDS) {
        if (mine) {
            *taken = TURN_SENDS;
        } else {
            job->kept[RUNGC_KEPT_PHASE] = PHASE_IDLE;
        }
    } else {
        /* it is done */
    }
    return RUNGC_OK;
}

static bool is_at_limit(const rungc_job *job, bool reverse)
{
    return rungc_has_on(job, job->wiring->limits[reverse ? 1 : 0]);
}

/* The same of one that is done when its train is. */
static rungc_fault take_turn(rungc_job *job, turn *taken)
{
    const rungc_fault fault = take_turn_resting(job, taken);
    rungc_generator *const generator = &job->axis->generator;

    if ((fault != RUNGC_OK) || (*taken != TURN_SENDS)) {
        return fault;
    }
    if (rungc_generator_is_complete(generator)) {
        rungc_finish(job);
        *taken = TURN_REST;
    } else if (is_at_limit(job, generator->reverse)) {
        rungc_generator_stop(generator);
        rungc_fail(job);
        *taken = TURN_REST;
    } else {
        /* it sends */
    }
    return RUNGC_OK;
}

void rungc_finish(rungc_job *job)
{
    job->kept[RUNGC_KEPT_PHASE] = PHASE_DONE;
}

void rungc_fail(rungc_job *job)
{
    job->kept[RUNGC_KEPT_PHASE] = PHASE_IDLE;
    rungc_set_relay(job->call.map, job->wiring->aborted, true);
    job->axis->owner = 0;
}

void rungc_send_train(rungc_job *job, const rungc_train *train, uint16_t counter)
{
    if (is_at_limit(job, train->reverse)) {
        rungc_fail(job);
    } else {
        rungc_send_train_anyway(job, train, counter);
    }
}

void rungc_send_train_anyway(rungc_job *job, const rungc_train *train, uint16_t counter)
{
    job->kept[RUNGC_KEPT_PHASE] = PHASE_SENDS;
    rungc_generator_start(&job->axis->generator, train);
    job->axis->owner = job->call.site.slot;
    job->axis->counter = counter;
    job->axis->ended = false;
    rungc_show_pin(job->axis);
}

/* Shows in the special relays how far the instruction is. */
static void show(rungc_job *job)
{
    rungc_map *const map = job->call.map;
    const rungc_site site = job->call.site;
    const bool busy = rungc_generator_millihertz(&job->axis->generator) > 0u;
    const int32_t phase = job->kept[RUNGC_KEPT_PHASE];

    rungc_show_pin(job->axis);
    if (!site.drive && (job->axis->owner == site.slot)) {
        job->axis->owner = 0;
    }
    set_relays(map, job->wiring->busy, busy);
    if (site.signal) {
        /* The state of the instruction itself is shown in the scan. */
        return;
    }
    if (site.drive) {
        rungc_set_relay(map, RUNGC_M_COMPLETE, phase == PHASE_DONE);
        if (phase != PHASE_IDLE) {
            job->kept[RUNGC_KEPT_SHOWN] = 1;
            rungc_set_relay(map, job->wiring->driven, true);
        }
        return;
    }
    /* One whose drive is off has nothing to show but that it has gone off. */
    if (phase != PHASE_IDLE) {
        job->kept[RUNGC_KEPT_PHASE] = PHASE_IDLE;
        rungc_set_relay(map, RUNGC_M_COMPLETE, false);
    }
    if (job->kept[RUNGC_KEPT_SHOWN] != 0) {
        job->kept[RUNGC_KEPT_SHOWN] = 0;
        rungc_set_relay(map, job->wiring->driven, false);
        rungc_set_relay(map, job->wiring->aborted, false);
    }
}

rungc_fault rungc_take_course(rungc_job *job, const rungc_operand operands[], const rungc_course *course)
{
    turn taken = TURN_REST;
    rungc_fault fault = course->ends_itself ? take_turn_resting(job, &taken) : take_turn(job, &taken);

    if (fault != RUNGC_OK) {
        return fault;
    }
    switch (taken) {
    case TURN_START:
        fault = course->begin(job, operands);
        break;
    case TURN_SENDS:
        fault = course->follow(job, operands);
        break;
    case TURN_RELEASED:
        fault = course->release(job, operands);
        break;
    default:
        break;
    }
    if (fault == RUNGC_OK) {
        show(job);
    }
    return fault;
}

rungc_fault rungc_come_down(rungc_job *job, const rungc_operand operands[])
{
    (void)operands;
    rungc_generator_stop(&job->axis->generator);
    return RUNGC_OK;
}

rungc_fault rungc_halt(rungc_job *job, const rungc_operand operands[])
{
    (void)operands;
    rungc_generator_halt(&job->axis->generator);
    return RUNGC_OK;
}

rungc_fault rungc_read_two(const rungc_call *call, const rungc_operand operands[], uint32_t *first, uint32_t *second)
{
    int32_t a = 0;
    int32_t b = 0;
    rungc_fault fault = rungc_read(call, operands[0], &a);

    if (fault == RUNGC_OK) {
        fault = rungc_read(call, operands[1], &b);
    }
    if ((fault == RUNGC_OK) && ((a < 0) || (b < 0))) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        *first = (uint32_t)a;
        *second = (uint32_t)b;
    }
    return fault;
}

void rungc_change_total(rungc_job *job, uint32_t total)
{
    rungc_generator *const generator = &job->axis->generator;

    if ((total > 0u) && rungc_has_on(job, job->wiring->changes) && !rungc_generator_is_ending(generator)) {
        rungc_generator_set_total(generator, total);
    }
}

const rungc_ramps *rungc_own_ramps(const rungc_job *job)
{
    const rungc_ramps *const own = &job->wiring->own;

    return ((own->base != 0u) && rungc_has_on(job, job->wiring->changes)) ? own : NULL;
}

uint32_t rungc_ramp_ms(const rungc_map *map, uint16_t number)
{
    const int32_t ms = rungc_register(map, number);

    if (ms < RUNGC_SHORTEST_RAMP_MS) {
        return RUNGC_SHORTEST_RAMP_MS;
    }
    return (uint32_t)((ms > RUNGC_LONGEST_RAMP_MS) ? RUNGC_LONGEST_RAMP_MS : ms);
}
