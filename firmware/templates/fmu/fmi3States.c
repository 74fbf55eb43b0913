/*
 * fmi3States.c: states of instances, to return to and to keep as bytes.
 */
#include "fmu_instance.h"

#include <stdlib.h>

/* A state that has left the FMU as bytes. */
typedef struct {
    char token[sizeof FMU_TOKEN];
    fmu_state state;
} fmu_record;

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    const fmu_instance *const own = instance;

    if ((own == NULL) || (state == NULL)) {
        return fmi3Error;
    }
    /* One that is there is overwritten. */
    fmu_state *const copy = (*state != NULL) ? *state : malloc(sizeof *copy);
    if (copy == NULL) {
        return fmu_error(own, "%s: no memory", "fmi3GetFMUState");
    }
    (void)memcpy(copy, &own->state, sizeof *copy);
    *state = copy;
    return fmi3OK;
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state)
{
    fmu_instance *const own = instance;

    if (own == NULL) {
        return fmi3Error;
    }
    if (state == NULL) {
        return fmu_error(own, "%s: there is no state", "fmi3SetFMUState");
    }
    (void)memcpy(&own->state, state, sizeof own->state);
    return fmi3OK;
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState *state)
{
    if (instance == NULL) {
        return fmi3Error;
    }
    if (state != NULL) {
        free(*state);
        *state = NULL;
    }
    return fmi3OK;
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state, size_t *size)
{
    if ((instance == NULL) || (state == NULL) || (size == NULL)) {
        return fmu_error(instance, "%s: there is no state", "fmi3SerializedFMUStateSize");
    }
    *size = sizeof(fmu_record);
    return fmi3OK;
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte serialized[], size_t size)
{
    if ((instance == NULL) || (state == NULL) || (serialized == NULL) || (size < sizeof(fmu_record))) {
        return fmu_error(instance, "%s: there is no state, or no room for it", "fmi3SerializeFMUState");
    }
    (void)memset(serialized, 0, size);
    (void)memcpy(&serialized[offsetof(fmu_record, token)], FMU_TOKEN, sizeof FMU_TOKEN);
    (void)memcpy(&serialized[offsetof(fmu_record, state)], state, sizeof(fmu_state));
    return fmi3OK;
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte serialized[], size_t size, fmi3FMUState *state)
{
    const fmu_instance *const own = instance;

    if ((own == NULL) || (state == NULL)) {
        return fmi3Error;
    }
    if ((serialized == NULL) || (size != sizeof(fmu_record)) ||
        (memcmp(&serialized[offsetof(fmu_record, token)], FMU_TOKEN, sizeof FMU_TOKEN) != 0)) {
        return fmu_error(own, "%s: this is not a state of this FMU", "fmi3DeserializeFMUState");
    }
    fmu_state *const copy = (*state != NULL) ? *state : malloc(sizeof *copy);
    if (copy == NULL) {
        return fmu_error(own, "%s: no memory", "fmi3DeserializeFMUState");
    }
    (void)memcpy(copy, &serialized[offsetof(fmu_record, state)], sizeof *copy);
    *state = copy;
    return fmi3OK;
}
