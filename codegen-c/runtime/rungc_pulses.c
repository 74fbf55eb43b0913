/*
 * rungc_pulses.c: pulses without a position: PLSY, PLSR, PWM (FNC 57 to 59).
 *
 * What an instruction asks of an output continues between scans; rungc_generator.c sends it.
 */
#include "rungc_outputs.h"

/* ---- PLSY S1 S2 D: S2 pulses of S1 Hz, or with S2 = 0 pulses without end ---------------------------------------------------------- */

/* A speed that is at least the model's lowest; 0 sends nothing. */
static uint32_t raised(const rungc_job *job, uint32_t hz)
{
    return ((hz > 0u) && (hz < job->family->lowest_hz)) ? job->family->lowest_hz : hz;
}

/* The speed and the number of pulses. */
static rungc_fault read_plsy(const rungc_job *job, const rungc_operand operands[], uint32_t *speed, uint32_t *count)
{
    uint32_t hz = 0;
    const rungc_fault fault = rungc_read_two(&job->call, operands, &hz, count);

    *speed = rungc_speed_of(job, raised(job, hz));
    return fault;
}

static rungc_fault begin_plsy(rungc_job *job, const rungc_operand operands[])
{
    uint32_t speed = 0;
    uint32_t count = 0;
    const rungc_fault fault = read_plsy(job, operands, &speed, &count);

    if (fault == RUNGC_OK) {
        const rungc_train train = rungc_steady_train(speed, count);

        rungc_send_train(job, &train, job->wiring->pulses);
    }
    return fault;
}

/* S1 may change at any time, S2 while the relay for that is on. */
static rungc_fault follow_plsy(rungc_job *job, const rungc_operand operands[])
{
    rungc_generator *const generator = &job->axis->generator;
    uint32_t speed = 0;
    uint32_t count = 0;
    const rungc_fault fault = read_plsy(job, operands, &speed, &count);

    if (fault != RUNGC_OK) {
        return fault;
    }
    rungc_generator_set_speed(generator, speed);
    if ((count > 0u) && rungc_has_on(job, job->wiring->changes)) {
        rungc_generator_set_total(generator, count);
    }
    return RUNGC_OK;
}

static rungc_fault plsy(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_plsy, follow_plsy, rungc_halt, false};

    return rungc_take_course(job, operands, &course);
}

void rungc_plsy(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, d};

    rungc_run_pulses(map, site, operands, 2, plsy);
}

/* ---- PLSR S1 S2 S3 D: S2 pulses, in S3 ms up to S1 Hz and in as many down --------------------------------------------------------- */

/* The ramps begin and end with the root of S1 / 2*S3. While the relay for that is on, the way down has its own time. */
static rungc_fault begin_plsr(rungc_job *job, const rungc_operand operands[])
{
    const rungc_ramps *const own = rungc_own_ramps(job);
    uint32_t hz = 0;
    uint32_t count = 0;
    int32_t ms = 0;
    rungc_fault fault = rungc_read_two(&job->call, operands, &hz, &count);

    if ((fault == RUNGC_OK) && (count < job->family->fewest_with_ramps)) {
        fault = RUNGC_BAD_VALUE;
    }
    if (fault == RUNGC_OK) {
        fault = rungc_read(&job->call, operands[2], &ms);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    hz = (hz < (uint32_t)RUNGC_LOWEST_HZ) ? (uint32_t)RUNGC_LOWEST_HZ : hz;
    hz = (hz > job->family->highest_hz) ? job->family->highest_hz : hz;
    ms = (ms < RUNGC_SHORTEST_RAMP_MS) ? RUNGC_SHORTEST_RAMP_MS : ms;
    ms = (ms > RUNGC_LONGEST_RAMP_MS) ? RUNGC_LONGEST_RAMP_MS : ms;

    rungc_train train = rungc_steady_train(1000u * hz, count);

    train.up = rungc_slope(hz, (uint32_t)ms);
    train.down = rungc_slope(hz, (own != NULL) ? rungc_ramp_ms(job->call.map, own->down) : (uint32_t)ms);
    train.lowest = train.up / 4u;
    rungc_send_train(job, &train, job->wiring->pulses);
    return RUNGC_OK;
}

/* S2 may change until the pulses come down. */
static rungc_fault follow_plsr(rungc_job *job, const rungc_operand operands[])
{
    int32_t count = 0;
    const rungc_fault fault = rungc_read(&job->call, operands[1], &count);

    if (fault == RUNGC_OK) {
        rungc_change_total(job, (count > 0) ? (uint32_t)count : 0u);
    }
    return fault;
}

static rungc_fault plsr(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_plsr, follow_plsr, rungc_come_down, false};

    return rungc_take_course(job, operands, &course);
}

void rungc_plsr(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand s3, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, s3, d};

    rungc_run_pulses(map, site, operands, 3, plsr);
}

/* ---- PWM S1 S2 D: pulses of width S1 and period S2, in milliseconds or in the unit that special devices say ----------------------- */

static uint32_t pwm_unit_us(const rungc_job *job)
{
    if (job->wiring->unit == 0u) {
        return rungc_has_on(job, job->wiring->micro) ? 1u : 1000u;
    }
    switch (rungc_register(job->call.map, job->wiring->unit)) {
    case 0:
    case 1:
        return 10;
    case 3:
        return 10000;
    default:
        return 1000;
    }
}

/* The signal that S1 and S2 say; both may change at any time. */
static rungc_fault run_pwm(rungc_job *job, const rungc_operand operands[], bool begins)
{
    uint32_t width = 0;
    uint32_t period = 0;
    const rungc_fault fault = rungc_read_two(&job->call, operands, &width, &period);

    if (fault != RUNGC_OK) {
        return fault;
    }
    if ((width > period) || (period == 0u)) {
        return RUNGC_BAD_VALUE;
    }
    if (begins) {
        const rungc_train nothing = rungc_steady_train(0, 0);

        rungc_send_train(job, &nothing, 0);
    }
    rungc_generator_modulate(&job->axis->generator, width, period, pwm_unit_us(job));
    return RUNGC_OK;
}

static rungc_fault begin_pwm(rungc_job *job, const rungc_operand operands[])
{
    return run_pwm(job, operands, true);
}

static rungc_fault follow_pwm(rungc_job *job, const rungc_operand operands[])
{
    return run_pwm(job, operands, false);
}

static rungc_fault pwm(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_pwm, follow_pwm, rungc_halt, true};

    return rungc_take_course(job, operands, &course);
}

void rungc_pwm(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, d};

    rungc_run_pulses(map, site, operands, 2, pwm);
}

/* ---- The pulses of an output stop at once, because an input says so --------------------------------------------------------------- */

static rungc_fault stop_pulses(rungc_job *job, const rungc_operand operands[])
{
    (void)operands;
    rungc_generator_halt(&job->axis->generator);
    job->axis->owner = 0;
    rungc_show_pin(job->axis);
    return RUNGC_OK;
}

void rungc_stop_pulses(rungc_map *map, rungc_site site, rungc_operand d)
{
    rungc_run_pulses(map, site, &d, 0, stop_pulses);
}
