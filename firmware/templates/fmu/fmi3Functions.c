/*
 * fmi3Functions.c: a PLC program as a functional mock-up unit for co-simulation: instances, their modes, and time.
 */
#include "fmu_instance.h"

#include <stdio.h>
#include <stdlib.h>

/* The longest simulation, in seconds. */
#define LONGEST_S 1e12

/* ---- Logging ----------------------------------------------------------------------------------------------------- */

/* Hands a message to the importer. */
static void log_text(const fmu_instance *instance, fmi3Status status, const char *category, const char *text)
{
    if (instance->log_message != NULL) {
        instance->log_message(instance->environment, status, category, text);
    }
}

fmi3Status fmu_error(const fmu_instance *instance, const char *format, const char *what)
{
    char text[256];
    const char *const place = strstr(format, "%s");
    const size_t length = (place != NULL) ? (size_t)(place - format) : strlen(format);

    if (instance != NULL) {
        (void)snprintf(text, sizeof text, "%.*s%s%s", (int)length, format, (place != NULL) ? what : "",
                       (place != NULL) ? (place + 2) : "");
        log_text(instance, fmi3Error, "logStatusError", text);
    }
    return fmi3Error;
}

/* Logs what has gone wrong in the program since the last time. */
static void log_plc_error(fmu_instance *instance)
{
    char text[128];
    plc_error *const logged = &instance->state.error;
    const plc_error now = fmu_last_error(&instance->state.plc);

    if ((now.code != 0u) && ((now.code != logged->code) || (now.step != logged->step)) && instance->logs_events) {
        (void)snprintf(text, sizeof text, "operation error %u at step %u", (unsigned)now.code, (unsigned)now.step);
        log_text(instance, fmi3Warning, "logEvents", text);
    }
    if ((now.stop != logged->stop) && (now.stop != (uint16_t)PLC_STOP_NONE) && instance->logs_events) {
        if (now.stop == (uint16_t)PLC_STOP_M8037) {
            (void)snprintf(text, sizeof text, "the program has stopped itself (M8037)");
        } else {
            (void)snprintf(text, sizeof text, "the PLC is in STOP: error %u at step %u", (unsigned)now.stop,
                           (unsigned)now.stop_step);
        }
        log_text(instance, fmi3Warning, "logEvents", text);
    }
    *logged = now;
}

/* ---- Instances --------------------------------------------------------------------------------------------------- */

/* The state before initialization. */
static void reset(fmu_state *state)
{
    (void)memset(state, 0, sizeof *state);
    fmu_init(&state->plc);
    state->scan_ms = FMU_SCAN_MS;
    state->mode = FMU_INSTANTIATED;
}

/* The instance, if it is in one of these modes. */
static fmu_instance *in_mode(fmi3Instance handle, fmu_mode first, fmu_mode last, const char *function)
{
    fmu_instance *const instance = handle;

    if ((instance != NULL) && ((instance->state.mode < first) || (instance->state.mode > last))) {
        (void)fmu_error(instance, "%s must not be called in this mode", function);
        return NULL;
    }
    return instance;
}

const char *fmi3GetVersion(void)
{
    return "3.0";
}

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String resourcePath,
                                         fmi3Boolean visible, fmi3Boolean loggingOn, fmi3Boolean eventModeUsed,
                                         fmi3Boolean earlyReturnAllowed,
                                         const fmi3ValueReference requiredIntermediateVariables[],
                                         size_t nRequiredIntermediateVariables, fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback logMessage,
                                         fmi3IntermediateUpdateCallback intermediateUpdate)
{
    fmu_instance draft;
    fmu_instance *instance = NULL;

    (void)name;
    (void)resourcePath;
    (void)visible;
    (void)earlyReturnAllowed;
    (void)requiredIntermediateVariables;
    (void)intermediateUpdate;
    (void)memset(&draft, 0, sizeof draft);
    draft.environment = environment;
    draft.log_message = logMessage;
    draft.logs_events = loggingOn;
    if ((token == NULL) || (strcmp(token, FMU_TOKEN) != 0)) {
        (void)fmu_error(&draft, "this FMU has another instantiation token than %s", (token != NULL) ? token : "NULL");
    } else if (eventModeUsed) {
        (void)fmu_error(&draft, "%s: this FMU has no event mode", "fmi3InstantiateCoSimulation");
    } else if (nRequiredIntermediateVariables != 0u) {
        (void)fmu_error(&draft, "%s: this FMU has no intermediate variables", "fmi3InstantiateCoSimulation");
    } else {
        instance = malloc(sizeof *instance);
        if (instance == NULL) {
            (void)fmu_error(&draft, "%s: no memory", "fmi3InstantiateCoSimulation");
        } else {
            *instance = draft;
            reset(&instance->state);
        }
    }
    return instance;
}

void fmi3FreeInstance(fmi3Instance instance)
{
    free(instance);
}

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean loggingOn, size_t nCategories,
                               const fmi3String categories[])
{
    fmu_instance *const own = instance;
    bool events = nCategories == 0u;

    if ((own == NULL) || ((nCategories != 0u) && (categories == NULL))) {
        return fmi3Error;
    }
    for (size_t i = 0; i < nCategories; i++) {
        const char *const category = (categories[i] != NULL) ? categories[i] : "NULL";

        if (strcmp(category, "logEvents") == 0) {
            events = true;
        } else if (strcmp(category, "logStatusError") != 0) {
            return fmu_error(own, "fmi3SetDebugLogging: there is no category %s", category);
        } else {
            /* Errors are always logged. */
        }
    }
    if (events) {
        own->logs_events = loggingOn;
    }
    return fmi3OK;
}

/* ---- Modes ------------------------------------------------------------------------------------------------------- */

/* Returns true for a number that is neither infinite nor undefined, up to the longest simulation. */
static bool is_time(double seconds)
{
    return (seconds >= -LONGEST_S) && (seconds <= LONGEST_S);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean toleranceDefined, fmi3Float64 tolerance,
                                       fmi3Float64 startTime, fmi3Boolean stopTimeDefined, fmi3Float64 stopTime)
{
    fmu_instance *const own = in_mode(instance, FMU_INSTANTIATED, FMU_INSTANTIATED, "fmi3EnterInitializationMode");

    (void)toleranceDefined;
    (void)tolerance;
    if (own == NULL) {
        return fmi3Error;
    }
    if (!is_time(startTime) || (stopTimeDefined && !(stopTime >= startTime))) {
        return fmu_error(own, "%s: these are not times of a simulation", "fmi3EnterInitializationMode");
    }
    own->state.start_s = startTime;
    own->state.mode = FMU_INITIALIZATION;
    return fmi3OK;
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance)
{
    fmu_instance *const own = in_mode(instance, FMU_INITIALIZATION, FMU_INITIALIZATION, "fmi3ExitInitializationMode");

    if (own == NULL) {
        return fmi3Error;
    }
    own->state.mode = FMU_STEP;
    return fmi3OK;
}

fmi3Status fmi3Terminate(fmi3Instance instance)
{
    fmu_instance *const own = in_mode(instance, FMU_INITIALIZATION, FMU_STEP, "fmi3Terminate");

    if (own == NULL) {
        return fmi3Error;
    }
    own->state.mode = FMU_TERMINATED;
    return fmi3OK;
}

fmi3Status fmi3Reset(fmi3Instance instance)
{
    fmu_instance *const own = instance;

    if (own == NULL) {
        return fmi3Error;
    }
    reset(&own->state);
    return fmi3OK;
}

/* ---- Time -------------------------------------------------------------------------------------------------------- */

/* Time passes between two scans. */
static void pass(fmu_state *state, uint64_t to_ms)
{
#ifdef fmu_tick
    while (state->now_ms < to_ms) {
        state->now_ms++;
        fmu_tick(&state->plc, (uint32_t)state->now_ms);
#ifdef fmu_take_interrupts
        fmu_take_interrupts(&state->plc);
#endif
    }
#else
    if (state->now_ms < to_ms) {
        state->now_ms = to_ms;
    }
#endif
}

/* A scan, as the simulator of rungc times it: one that waits for a constant scan time takes that long. */
static void scan(fmu_instance *instance)
{
    fmu_state *const state = &instance->state;
    uint32_t scan_ms = (uint32_t)state->scan_ms;

    if (scan_ms < state->constant_ms) {
        scan_ms = state->constant_ms;
    }
    fmu_scan(&state->plc, (uint32_t)state->now_ms, scan_ms * 1000u);
    state->scanned = true;
#ifdef fmu_constant_scan_us
    state->constant_ms = fmu_constant_scan_us(&state->plc) / 1000u;
    scan_ms = ((uint32_t)state->scan_ms < state->constant_ms) ? state->constant_ms : (uint32_t)state->scan_ms;
#else
    scan_ms = (uint32_t)state->scan_ms;
#endif
    state->scan_at_ms += scan_ms;
    log_plc_error(instance);
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 currentCommunicationPoint, fmi3Float64 communicationStepSize,
                      fmi3Boolean noSetFMUStatePriorToCurrentPoint, fmi3Boolean *eventHandlingNeeded,
                      fmi3Boolean *terminateSimulation, fmi3Boolean *earlyReturn, fmi3Float64 *lastSuccessfulTime)
{
    fmu_instance *const own = in_mode(instance, FMU_STEP, FMU_STEP, "fmi3DoStep");
    const double end_s = currentCommunicationPoint + communicationStepSize;

    (void)noSetFMUStatePriorToCurrentPoint;
    if (own == NULL) {
        return fmi3Error;
    }
    fmu_state *const state = &own->state;
    const double passed_s = end_s - state->start_s;
    if (!(communicationStepSize > 0.0) || !is_time(end_s) || !(passed_s > 0.0) || !is_time(passed_s)) {
        return fmu_error(own, "%s: the communication point or the step size is wrong", "fmi3DoStep");
    }
    const uint64_t end_us = (uint64_t)((passed_s * 1e6) + 0.5);
    if (end_us < state->end_us) {
        return fmu_error(own, "%s: the step ends before the last one", "fmi3DoStep");
    }
    state->end_us = end_us;
    while ((state->scan_at_ms * 1000u) < end_us) {
        pass(state, state->scan_at_ms);
        scan(own);
    }
    pass(state, end_us / 1000u);
    if (eventHandlingNeeded != NULL) {
        *eventHandlingNeeded = false;
    }
    if (terminateSimulation != NULL) {
        *terminateSimulation = false;
    }
    if (earlyReturn != NULL) {
        *earlyReturn = false;
    }
    if (lastSuccessfulTime != NULL) {
        *lastSuccessfulTime = end_s;
    }
    return fmi3OK;
}
