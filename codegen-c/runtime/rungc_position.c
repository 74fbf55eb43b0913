/*
 * rungc_position.c: moves: DRVI, DRVA, DVIT, PLSV (FNC 151, 157 to 159). Positions are counted in the registers of the output;
 * forward counts up.
 */
#include "rungc_ramps.h"

/* Sets the operand for the direction, which is on forward. */
static rungc_fault set_direction(const rungc_job *job, rungc_operand direction, bool forward)
{
    return rungc_write_bit(&job->call, direction, 0, forward);
}

static uint32_t magnitude(int32_t value)
{
    return (value < 0) ? (0u - (uint32_t)value) : (uint32_t)value;
}

static int32_t position(const rungc_job *job)
{
    return (job->wiring->position != 0u) ? rungc_long_register(job->call.map, job->wiring->position) : 0;
}

/* ---- DRVI S1 S2 D1 D2 moves by S1 pulses at S2 Hz with ramps, DRVA to position S1 ------------------------------------------------- */

/* Word that keeps the position in which a move began. */
enum { KEPT_BEGAN = 4 };

/* Begins a move by this distance. */
static rungc_fault begin_move(rungc_job *job, const rungc_operand operands[], int32_t distance)
{
    int32_t hz = 0;
    rungc_fault fault = rungc_read_in(&job->call, operands[1], 0, INT32_MAX, &hz);

    if (fault != RUNGC_OK) {
        return fault;
    }
    job->kept[KEPT_BEGAN] = position(job);
    fault = set_direction(job, operands[3], distance >= 0);
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (distance == 0) {
        rungc_finish(job);
    } else {
        const rungc_profile profile = rungc_profile_of(job);
        const rungc_train train = rungc_profile_train(&profile, (uint32_t)hz, magnitude(distance), distance < 0);

        rungc_send_train(job, &train, job->wiring->position);
    }
    return RUNGC_OK;
}

/* While the relay for that is on, the distance may change until the move comes down. */
static void change_distance(rungc_job *job, int32_t distance)
{
    if ((distance < 0) == job->axis->generator.reverse) {
        rungc_change_total(job, magnitude(distance));
    }
}

static rungc_fault begin_drvi(rungc_job *job, const rungc_operand operands[])
{
    int32_t distance = 0;
    const rungc_fault fault = rungc_read(&job->call, operands[0], &distance);

    return (fault != RUNGC_OK) ? fault : begin_move(job, operands, distance);
}

static rungc_fault follow_drvi(rungc_job *job, const rungc_operand operands[])
{
    int32_t distance = 0;
    const rungc_fault fault = rungc_read(&job->call, operands[0], &distance);

    if (fault == RUNGC_OK) {
        change_distance(job, distance);
    }
    return fault;
}

static rungc_fault drvi(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_drvi, follow_drvi, rungc_come_down, false};

    return rungc_take_course(job, operands, &course);
}

static rungc_fault begin_drva(rungc_job *job, const rungc_operand operands[])
{
    int32_t target = 0;
    const rungc_fault fault = rungc_read(&job->call, operands[0], &target);

    return (fault != RUNGC_OK) ? fault : begin_move(job, operands, plc_sat_sub32(target, position(job)));
}

static rungc_fault follow_drva(rungc_job *job, const rungc_operand operands[])
{
    int32_t target = 0;
    const rungc_fault fault = rungc_read(&job->call, operands[0], &target);

    if (fault == RUNGC_OK) {
        change_distance(job, plc_sat_sub32(target, job->kept[KEPT_BEGAN]));
    }
    return fault;
}

static rungc_fault drva(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_drva, follow_drva, rungc_come_down, false};

    return rungc_take_course(job, operands, &course);
}

void rungc_drvi(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d1, rungc_operand d2)
{
    const rungc_operand operands[] = {s1, s2, d1, d2};

    rungc_run_pulses(map, site, operands, 2, drvi);
}

void rungc_drva(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d1, rungc_operand d2)
{
    const rungc_operand operands[] = {s1, s2, d1, d2};

    rungc_run_pulses(map, site, operands, 2, drva);
}

/* ---- DVIT S1 S2 D1 D2 runs at S2 Hz until its signal, then by |S1| pulses --------------------------------------------------------- */

/* Words that keep whether the signal was on, how many pulses follow it, and whether it has come. */
enum { KEPT_SIGNAL = 5, KEPT_PULSES = 6, KEPT_INTERRUPTED = 7 };

/* A register names no interrupt input. */
enum { NO_INTERRUPT_INPUT = 6763 };

static bool input_is_on(const rungc_job *job, uint32_t number)
{
    bool *bit = NULL;
    const bool on = rungc_find_bit(job->call.map, 0u, RUNGC_CLASS_X, number, &bit) && (bit != NULL) && *bit;

    return on != rungc_has_on(job, job->wiring->interrupt.inverted);
}

/* Returns whether the signal that it waits for is on. */
static rungc_fault read_signal(const rungc_job *job, bool *on)
{
    const rungc_interrupt *const interrupt = &job->wiring->interrupt;

    if ((interrupt->number == 0u) || !rungc_has_on(job, interrupt->chooses)) {
        *on = input_is_on(job, interrupt->input);
        return RUNGC_OK;
    }
    const uint32_t digits = (uint16_t)rungc_register(job->call.map, interrupt->number);
    const uint32_t number = (digits >> (4u * job->output)) & 15u;

    if (number > 8u) {
        return NO_INTERRUPT_INPUT;
    }
    *on = (number == 8u) ? rungc_has_on(job, interrupt->relay) : input_is_on(job, number);
    return RUNGC_OK;
}

static rungc_fault begin_dvit(rungc_job *job, const rungc_operand operands[])
{
    int32_t distance = 0;
    int32_t hz = 0;
    bool on = false;
    rungc_fault fault = rungc_read(&job->call, operands[0], &distance);

    if (fault == RUNGC_OK) {
        fault = rungc_read_in(&job->call, operands[1], 0, INT32_MAX, &hz);
    }
    if ((fault == RUNGC_OK) && (distance == 0)) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        fault = read_signal(job, &on);
    }
    if (fault == RUNGC_OK) {
        job->kept[KEPT_SIGNAL] = on ? 1 : 0;
        job->kept[KEPT_PULSES] = (distance < 0) ? plc_sat_sub32(0, distance) : distance;
        job->kept[KEPT_INTERRUPTED] = 0;
        fault = set_direction(job, operands[3], distance > 0);
    }
    if (fault == RUNGC_OK) {
        const rungc_profile profile = rungc_profile_of(job);
        const rungc_train train = rungc_profile_train(&profile, (uint32_t)hz, 0, distance < 0);

        rungc_send_train(job, &train, job->wiring->position);
    }
    return fault;
}

/* At the rising edge of the signal it continues by its pulses. */
static rungc_fault follow_dvit(rungc_job *job, const rungc_operand operands[])
{
    const bool was_on = job->kept[KEPT_SIGNAL] != 0;
    bool on = false;
    const rungc_fault fault = read_signal(job, &on);

    (void)operands;
    if (fault != RUNGC_OK) {
        return fault;
    }
    job->kept[KEPT_SIGNAL] = on ? 1 : 0;
    if (on && !was_on && (job->kept[KEPT_INTERRUPTED] == 0)) {
        job->kept[KEPT_INTERRUPTED] = 1;
        rungc_generator_end_in(&job->axis->generator, magnitude(job->kept[KEPT_PULSES]));
    }
    return RUNGC_OK;
}

static rungc_fault dvit(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_dvit, follow_dvit, rungc_come_down, false};

    return rungc_take_course(job, operands, &course);
}

void rungc_dvit(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d1, rungc_operand d2)
{
    const rungc_operand operands[] = {s1, s2, d1, d2};

    rungc_run_pulses(map, site, operands, 2, dvit);
}

/* ---- PLSV S D1 D2 sends pulses of |S| Hz as long as it is driven ------------------------------------------------------------------ */

static bool has_ramps(const rungc_job *job)
{
    return rungc_has_on(job, job->wiring->slides);
}

/* Sends pulses of the speed and in the direction that PLSV says. */
static rungc_fault begin_plsv(rungc_job *job, const rungc_operand operands[])
{
    int32_t speed = 0;
    rungc_train train;
    rungc_fault fault = rungc_read(&job->call, operands[0], &speed);

    if (fault == RUNGC_OK) {
        fault = set_direction(job, operands[2], speed >= 0);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (has_ramps(job)) {
        const rungc_profile profile = rungc_profile_for_all(job);

        train = rungc_endless_train(&profile, magnitude(speed), speed < 0);
    } else {
        train = rungc_steady_train(rungc_speed_of(job, magnitude(speed)), 0);
        train.reverse = speed < 0;
    }
    rungc_send_train(job, &train, job->wiring->position);
    return RUNGC_OK;
}

/* S may change at any time: at once, or with ramps. A moving axis slows down before it reverses. */
static rungc_fault follow_plsv(rungc_job *job, const rungc_operand operands[])
{
    rungc_generator *const generator = &job->axis->generator;
    int32_t speed = 0;
    const rungc_fault fault = rungc_read(&job->call, operands[0], &speed);
    const bool turns = (speed != 0) && (generator->reverse != (speed < 0));

    if (fault != RUNGC_OK) {
        return fault;
    }
    if (!generator->busy) {
        return begin_plsv(job, operands);
    }
    if (generator->stopped) {
        return RUNGC_OK;
    }
    if (!turns) {
        rungc_generator_set_speed(generator, rungc_speed_of(job, magnitude(speed)));
    } else if (has_ramps(job)) {
        rungc_generator_stop(generator);
    } else {
        return begin_plsv(job, operands);
    }
    return RUNGC_OK;
}

static rungc_fault release_plsv(rungc_job *job, const rungc_operand operands[])
{
    return has_ramps(job) ? rungc_come_down(job, operands) : rungc_halt(job, operands);
}

static rungc_fault plsv(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_plsv, follow_plsv, release_plsv, false};

    return rungc_take_course(job, operands, &course);
}

void rungc_plsv(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d1, rungc_operand d2)
{
    const rungc_operand operands[] = {s, d1, d2};

    rungc_run_pulses(map, site, operands, 1, plsv);
}
