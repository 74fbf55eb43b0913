/*
 * rungc_pulses.c: pulses without a position: PLSY, PLSR, PWM (FNC 57 to 59).
 *
 * What an instruction asks of an output continues between scans; rungc_generator.c sends it.
 */
#include "rungc_outputs.h"

/* The first two operands, which are not negative. An operand that does not exist is reported before one that is negative. */
static rungc_fault read_two(const rungc_call *call, const rungc_operand operands[], uint32_t *first, uint32_t *second)
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

/* ---- PLSY S1 S2 D: S2 pulses of S1 Hz, or with S2 = 0 pulses without end ---------------------------------------------------------- */

/* A speed that is at least the model's lowest; 0 sends nothing. */
static uint32_t raised(const rungc_job *job, uint32_t hz)
{
    return ((hz > 0u) && (hz < job->family->lowest_hz)) ? job->family->lowest_hz : hz;
}

/* S1 may change at any time, S2 while the relay for that is on; the pulses stop at once with the drive. */
static rungc_fault plsy(rungc_job *job, const rungc_operand operands[])
{
    rungc_generator *const generator = &job->axis->generator;
    rungc_turn turn = RUNGC_TURN_REST;
    uint32_t hz = 0;
    uint32_t count = 0;
    rungc_fault fault = rungc_take_turn(job, &turn);

    if ((fault == RUNGC_OK) && ((turn == RUNGC_TURN_START) || (turn == RUNGC_TURN_SENDS))) {
        fault = read_two(&job->call, operands, &hz, &count);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const uint32_t speed = rungc_speed_of(job, raised(job, hz));

    switch (turn) {
    case RUNGC_TURN_START: {
        const rungc_train train = rungc_steady_train(speed, count);

        rungc_send_train(job, &train, job->wiring->pulses);
        break;
    }
    case RUNGC_TURN_SENDS:
        rungc_generator_set_speed(generator, speed);
        if ((count > 0u) && rungc_has_on(job, job->wiring->changes)) {
            rungc_generator_set_total(generator, count);
        }
        break;
    case RUNGC_TURN_RELEASED:
        rungc_generator_halt(generator);
        break;
    default:
        break;
    }
    rungc_show(job);
    return RUNGC_OK;
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
    rungc_fault fault = read_two(&job->call, operands, &hz, &count);

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

/* The pulses come down when the drive goes off. S2 may change until they come down. */
static rungc_fault plsr(rungc_job *job, const rungc_operand operands[])
{
    rungc_turn turn = RUNGC_TURN_REST;
    int32_t count = 0;
    rungc_fault fault = rungc_take_turn(job, &turn);

    if (fault != RUNGC_OK) {
        return fault;
    }
    switch (turn) {
    case RUNGC_TURN_START:
        fault = begin_plsr(job, operands);
        break;
    case RUNGC_TURN_SENDS:
        fault = rungc_read(&job->call, operands[1], &count);
        if (fault == RUNGC_OK) {
            rungc_change_total(job, (count > 0) ? (uint32_t)count : 0u);
        }
        break;
    case RUNGC_TURN_RELEASED:
        rungc_generator_stop(&job->axis->generator);
        break;
    default:
        break;
    }
    if (fault == RUNGC_OK) {
        rungc_show(job);
    }
    return fault;
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

/* Both may change at any time. */
static rungc_fault pwm(rungc_job *job, const rungc_operand operands[])
{
    rungc_turn turn = RUNGC_TURN_REST;
    uint32_t width = 0;
    uint32_t period = 0;
    rungc_fault fault = rungc_take_turn_resting(job, &turn);

    if ((fault == RUNGC_OK) && ((turn == RUNGC_TURN_START) || (turn == RUNGC_TURN_SENDS))) {
        fault = read_two(&job->call, operands, &width, &period);
        if ((fault == RUNGC_OK) && ((width > period) || (period == 0u))) {
            fault = RUNGC_BAD_VALUE;
        }
        if (fault == RUNGC_OK) {
            if (turn == RUNGC_TURN_START) {
                const rungc_train nothing = rungc_steady_train(0, 0);

                rungc_send_train(job, &nothing, 0);
            }
            rungc_generator_modulate(&job->axis->generator, width, period, pwm_unit_us(job));
        }
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (turn == RUNGC_TURN_RELEASED) {
        rungc_generator_halt(&job->axis->generator);
    }
    rungc_show(job);
    return RUNGC_OK;
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
