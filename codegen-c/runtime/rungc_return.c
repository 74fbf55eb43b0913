/*
 * rungc_return.c: returns to the origin: ZRN and DSZR (FNC 156 and 150).
 */
#include "rungc_ramps.h"

/* Word that keeps the stage of a return. */
enum { KEPT_STAGE = 4 };

/* ---- ZRN S1 S2 S3 D runs back at S1 Hz until S3 is on, then at S2 Hz until it is off: there is the origin ------------------------- */

/* A scan in which it begins or sends. */
static rungc_fault run_zrn(rungc_job *job, const rungc_operand operands[], bool starts)
{
    uint32_t fast = 0;
    uint32_t creep = 0;
    bool near = false;
    rungc_fault fault = rungc_read_two(&job->call, operands, &fast, &creep);

    if (fault == RUNGC_OK) {
        fault = rungc_read_bit(&job->call, operands[2], 0, &near);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (starts) {
        const rungc_profile profile = rungc_profile_for_all(job);
        const rungc_train train = rungc_endless_train(&profile, near ? creep : fast, true);

        rungc_send_train(job, &train, job->wiring->position);
        job->kept[KEPT_STAGE] = near ? 1 : 0;
    }
    if (near && (job->kept[KEPT_STAGE] == 0)) {
        rungc_generator_set_speed(&job->axis->generator, rungc_speed_of(job, creep));
        job->kept[KEPT_STAGE] = 1;
    } else if (!near && (job->kept[KEPT_STAGE] != 0)) {
        rungc_arrive_home(job);
        rungc_begin_clear_signal(job, &job->wiring->zrn_clear);
    } else {
        /* it is on its way */
    }
    return RUNGC_OK;
}

static rungc_fault begin_zrn(rungc_job *job, const rungc_operand operands[])
{
    return run_zrn(job, operands, true);
}

static rungc_fault follow_zrn(rungc_job *job, const rungc_operand operands[])
{
    return run_zrn(job, operands, false);
}

static rungc_fault zrn(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_zrn, follow_zrn, rungc_come_down, false};

    rungc_end_clear_signal(job, &job->wiring->zrn_clear);
    return rungc_take_course(job, operands, &course);
}

void rungc_zrn(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand s3, rungc_operand d)
{
    const rungc_operand operands[] = {s1, s2, s3, d};

    rungc_run_pulses(map, site, operands, 3, zrn);
}

/* ---- DSZR S1 S2 D1 D2 runs until the DOG S1 is on, creeps until it is off, and then to the next rise of the zero signal S2 --------- */

/* Begun over the DOG or past it, at the limit, it first runs back until the DOG is left. With S1 = S2 the fall of the DOG is the
   origin. Stages that run against the direction of the return come first. */
enum {
    STAGE_LEAVE = 0,     /* leaves the DOG against the direction of the return */
    STAGE_SEEK_BACK = 1, /* seeks the DOG against that direction, from the limit */
    STAGE_OVER = 2,      /* is over the DOG on that way */
    STAGE_TURN = 3,      /* comes to a halt, to turn round */
    STAGE_SEEK = 4,      /* seeks the DOG */
    STAGE_CREEP = 5,     /* creeps over the DOG */
    STAGE_ZERO = 6,      /* waits for the zero signal after it */
    STAGE_TURN_BACK = 7  /* comes to a halt at the limit of the return, to seek back */
};

/* Word that keeps whether the zero signal was on. */
enum { KEPT_ZERO = 5 };

/* Lowest speed but for the base and the creep speed, in Hz. */
enum { LOWEST_RETURN_HZ = 715 };

/* Its signals, their logic regarded. */
typedef struct signals {
    bool dog;
    bool zero;
    bool limit;       /* the limit switch in the direction of the return */
    bool other_limit; /* the one in the other direction */
    bool same;        /* DOG and zero signal are one input */
    bool forward;     /* the return runs forward */
} signals;

static bool same_operand(rungc_operand a, rungc_operand b)
{
    return (a.kind == b.kind) && (a.class_ == b.class_) && (a.digits == b.digits) && (a.area == b.area) && (a.value == b.value);
}

static rungc_fault read_signals(const rungc_job *job, const rungc_operand operands[], signals *read)
{
    const rungc_home *const home = &job->wiring->home;
    rungc_fault fault;
    bool on = false;

    if (home->forward == 0u) {
        return RUNGC_NO_DEVICE;
    }
    const bool ahead = rungc_has_on(job, home->limits[0]);
    const bool back = rungc_has_on(job, home->limits[1]);

    read->same = same_operand(operands[0], operands[1]);
    read->forward = rungc_has_on(job, home->forward);
    read->limit = read->forward ? ahead : back;
    read->other_limit = read->forward ? back : ahead;
    fault = rungc_read_bit(&job->call, operands[0], 0, &on);
    if (fault != RUNGC_OK) {
        return fault;
    }
    read->dog = on != rungc_has_on(job, home->dog_inverted);
    read->zero = read->dog;
    if (!read->same) {
        fault = rungc_read_bit(&job->call, operands[1], 0, &on);
        read->zero = on != rungc_has_on(job, home->zero_inverted);
    }
    return fault;
}

/* Speeds of a return, in Hz. */
typedef struct speeds {
    rungc_profile profile;
    uint32_t fast;
    uint32_t creep;
} speeds;

/* Speeds that contradict each other are an error, others are held in their limits. */
static rungc_fault read_home_speeds(const rungc_job *job, speeds *read)
{
    const rungc_map *const map = job->call.map;
    const rungc_home *const home = &job->wiring->home;

    if (home->forward == 0u) {
        return RUNGC_NO_DEVICE;
    }
    const int32_t highest = rungc_long_register(map, home->ramps.highest);
    const int32_t base = rungc_register(map, home->ramps.base);
    const int32_t creep = rungc_register(map, home->creep);
    const int32_t fast = rungc_long_register(map, home->speed);

    if ((creep < 0) || (creep < base) || (fast < base) || (highest < creep)) {
        return RUNGC_NO_DEVICE;
    }
    read->profile.highest = rungc_within(highest, LOWEST_RETURN_HZ, job->family->highest_hz);
    read->profile.base = rungc_within(base, 0, read->profile.highest);
    read->profile.up_ms = rungc_ramp_ms(map, home->ramps.up);
    read->profile.down_ms = rungc_ramp_ms(map, home->ramps.down);
    read->profile.raises_speeds = false;
    read->fast = rungc_within(fast, LOWEST_RETURN_HZ, read->profile.highest);
    read->creep = rungc_within(creep, RUNGC_LOWEST_HZ, read->profile.highest);
    return RUNGC_OK;
}

/* Runs a stage at the speed of the return: against its direction, or in it. */
static rungc_fault run_stage(rungc_job *job, rungc_operand direction, const speeds *home, const signals *now, int32_t stage)
{
    const bool forward = now->forward == (stage >= STAGE_SEEK);
    const rungc_train train = rungc_endless_train(&home->profile, home->fast, !forward);
    const rungc_fault fault = rungc_write_bit(&job->call, direction, 0, forward);

    if (fault == RUNGC_OK) {
        job->kept[KEPT_STAGE] = stage;
        rungc_send_train_anyway(job, &train, job->wiring->position);
    }
    return fault;
}

static rungc_fault begin_dszr(rungc_job *job, const rungc_operand operands[])
{
    speeds home;
    signals now;
    int32_t stage = STAGE_SEEK;
    rungc_fault fault = read_home_speeds(job, &home);

    if (fault == RUNGC_OK) {
        fault = read_signals(job, operands, &now);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    if (now.limit) {
        stage = STAGE_SEEK_BACK;
    } else if (now.dog) {
        stage = STAGE_LEAVE;
    } else {
        /* the DOG is ahead */
    }
    job->kept[KEPT_ZERO] = now.zero ? 1 : 0;
    return run_stage(job, operands[3], &home, &now, stage);
}

/* Comes to a halt, for the next stage. */
static void stop_for(rungc_job *job, int32_t stage)
{
    rungc_generator_stop(&job->axis->generator);
    job->kept[KEPT_STAGE] = stage;
}

static void arrive(rungc_job *job)
{
    rungc_arrive_home(job);
    rungc_begin_clear_signal(job, &job->wiring->home.clear);
}

/* The output is at a limit where it cannot turn. */
static void give_up(rungc_job *job)
{
    rungc_generator_stop(&job->axis->generator);
    rungc_fail(job);
}

/* What the signals mean in this stage. Returns false if the return has failed. */
static bool follow_signals(rungc_job *job, const speeds *home, const signals *now, bool zero_rises)
{
    const int32_t stage = job->kept[KEPT_STAGE];

    if ((stage < STAGE_TURN) && now->other_limit) {
        give_up(job);
        return false;
    }
    switch (stage) {
    case STAGE_SEEK_BACK:
        if (now->dog) {
            job->kept[KEPT_STAGE] = STAGE_OVER;
        }
        return true;
    case STAGE_LEAVE:
    case STAGE_OVER:
        if (!now->dog) {
            stop_for(job, STAGE_TURN);
        }
        return true;
    case STAGE_SEEK:
        if (now->dog) {
            rungc_generator_set_speed(&job->axis->generator, 1000u * home->creep);
            job->kept[KEPT_STAGE] = STAGE_CREEP;
        } else if (now->limit) {
            stop_for(job, STAGE_TURN_BACK);
        } else {
            /* it is on its way */
        }
        return true;
    case STAGE_CREEP:
        if (!now->dog && now->same) {
            arrive(job);
            return true;
        }
        if (!now->dog) {
            job->kept[KEPT_STAGE] = STAGE_ZERO;
            return true;
        }
        break;
    case STAGE_ZERO:
        if (zero_rises) {
            arrive(job);
            return true;
        }
        break;
    default:
        return true;
    }
    if (now->limit) {
        give_up(job);
        return false;
    }
    return true;
}

static rungc_fault follow_dszr(rungc_job *job, const rungc_operand operands[])
{
    speeds home;
    signals now;
    rungc_fault fault = read_signals(job, operands, &now);

    if (fault == RUNGC_OK) {
        fault = read_home_speeds(job, &home);
    }
    if (fault != RUNGC_OK) {
        return fault;
    }
    const bool zero_rises = now.zero && (job->kept[KEPT_ZERO] == 0);

    job->kept[KEPT_ZERO] = now.zero ? 1 : 0;
    if (!follow_signals(job, &home, &now, zero_rises) || job->axis->generator.busy) {
        return RUNGC_OK;
    }
    switch (job->kept[KEPT_STAGE]) {
    case STAGE_TURN:
        return run_stage(job, operands[3], &home, &now, STAGE_SEEK);
    case STAGE_TURN_BACK:
        return run_stage(job, operands[3], &home, &now, STAGE_SEEK_BACK);
    default:
        return RUNGC_OK;
    }
}

static rungc_fault dszr(rungc_job *job, const rungc_operand operands[])
{
    static const rungc_course course = {begin_dszr, follow_dszr, rungc_come_down, true};

    rungc_end_clear_signal(job, &job->wiring->home.clear);
    return rungc_take_course(job, operands, &course);
}

void rungc_dszr(rungc_map *map, rungc_site site, rungc_operand s1, rungc_operand s2, rungc_operand d1, rungc_operand d2)
{
    const rungc_operand operands[] = {s1, s2, d1, d2};

    rungc_run_pulses(map, site, operands, 2, dszr);
}
