/*
 * fmi3Variables.c: the devices of the program as variables.
 */
#include "fmu_instance.h"

#include <stdio.h>

/* Value references that are not those of devices. */
enum { TIME_REFERENCE = 0, SCAN_REFERENCE = 1 };

/* Bounds of the scan time in milliseconds. */
enum { FEWEST_MS = 1, MOST_MS = 32767 };

/* Parts of a value reference: the class of a device plus one, how its value is stored, its number. */
#define CLASS_SHIFT 18
#define STORED_MASK 0x30000u
#define NUMBER_MASK 0xFFFFu

/* The variable of a value reference, if it has this type. */
static const fmu_variable *find(const fmu_instance *instance, fmi3ValueReference reference, uint8_t type)
{
    size_t low = 0;
    size_t high = fmu_variable_count;
    char text[64];

    while (low < high) {
        const size_t middle = low + ((high - low) / 2u);

        if (fmu_variables[middle].reference < reference) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    if (low < fmu_variable_count) {
        const fmu_variable *const found = &fmu_variables[low];

        if ((found->reference == reference) && (found->type == type)) {
            return found;
        }
    }
    (void)snprintf(text, sizeof text, "%lu", (unsigned long)reference);
    (void)fmu_error(instance, "there is no variable of this type with the value reference %s", text);
    return NULL;
}

static plc_class class_of(const fmu_variable *variable)
{
    return (plc_class)((variable->reference >> CLASS_SHIFT) - 1u);
}

/* The value of a variable as 32 bits. */
static int32_t read(const fmu_instance *instance, const fmu_variable *variable)
{
    const fmu_plc *const plc = &instance->state.plc;
    const plc_class device = class_of(variable);
    const uint32_t number = variable->reference & NUMBER_MASK;
    int32_t value = 0;
    int32_t high = 0;

    if (device == PLC_CLASS_Y) {
        value = fmu_output(plc, (unsigned)number) ? 1 : 0;
    } else {
        /* The program stores all of its variables. */
        (void)fmu_read(plc, device, number, &value);
        if ((variable->reference & STORED_MASK) != 0u) {
            (void)fmu_read(plc, device, number + 1u, &high);
            const uint32_t both = ((uint32_t)high << 16) | ((uint32_t)value & 0xFFFFu);
            (void)memcpy(&value, &both, sizeof value);
        }
    }
    return value;
}

/* A half of a number as a signed word. */
static int32_t word_of(uint32_t bits)
{
    const uint16_t low = (uint16_t)(bits & 0xFFFFu);
    int16_t word = 0;

    (void)memcpy(&word, &low, sizeof word);
    return word;
}

/* Writes a device that is one bit, word or counter. Once the PLC scans, an input X that changes has an edge. */
static bool write_single(fmu_state *state, plc_class device, uint32_t number, int32_t value)
{
#ifdef fmu_input_edge
    int32_t before = value;

    if ((device == PLC_CLASS_X) && state->scanned) {
        (void)fmu_read(&state->plc, device, number, &before);
        if (before != value) {
            fmu_input_edge(&state->plc, (unsigned)number, value != 0);
        }
    }
#endif
    const bool written = fmu_write(&state->plc, device, number, value);
#ifdef fmu_take_interrupts
    if (device == PLC_CLASS_X) {
        fmu_take_interrupts(&state->plc);
    }
#endif
    return written;
}

/* Sets an input. */
static fmi3Status write(fmu_instance *instance, const fmu_variable *variable, int32_t value)
{
    fmu_state *const state = &instance->state;
    const plc_class device = class_of(variable);
    const uint32_t number = variable->reference & NUMBER_MASK;
    bool written = false;

    if (!variable->input || (state->mode == FMU_TERMINATED)) {
        return fmu_error(instance, "%s cannot be set now", variable->name);
    }
    if ((variable->reference & STORED_MASK) != 0u) {
        const uint32_t bits = (uint32_t)value;

        written = fmu_write(&state->plc, device, number, word_of(bits)) &&
                  fmu_write(&state->plc, device, number + 1u, word_of(bits >> 16));
    } else {
        written = write_single(state, device, number, value);
    }
    return written ? fmi3OK : fmu_error(instance, "%s cannot hold this value", variable->name);
}

/* The instance, if the lengths of references and values fit. */
static fmu_instance *fitting(fmi3Instance handle, const void *references, size_t nReferences, const void *values,
                             size_t nValues)
{
    fmu_instance *const instance = handle;
    const bool empty = nReferences == 0u;

    if ((instance != NULL) &&
        ((nReferences != nValues) || (!empty && ((references == NULL) || (values == NULL))))) {
        (void)fmu_error(instance, "%s: each variable has one value", "fmi3Get or fmi3Set");
        return NULL;
    }
    return instance;
}

fmi3Status fmi3GetBoolean(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                          fmi3Boolean values[], size_t nValues)
{
    const fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        const fmu_variable *const variable = find(own, references[i], FMU_BOOLEAN);

        if (variable == NULL) {
            status = fmi3Error;
        } else {
            values[i] = read(own, variable) != 0;
        }
    }
    return status;
}

fmi3Status fmi3SetBoolean(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                          const fmi3Boolean values[], size_t nValues)
{
    fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        const fmu_variable *const variable = find(own, references[i], FMU_BOOLEAN);

        status = (variable != NULL) ? write(own, variable, values[i] ? 1 : 0) : fmi3Error;
    }
    return status;
}

fmi3Status fmi3GetInt16(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                        fmi3Int16 values[], size_t nValues)
{
    const fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        const fmu_variable *const variable = find(own, references[i], FMU_INT16);

        if (variable == NULL) {
            status = fmi3Error;
        } else {
            values[i] = (fmi3Int16)read(own, variable);
        }
    }
    return status;
}

fmi3Status fmi3SetInt16(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                        const fmi3Int16 values[], size_t nValues)
{
    fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        const fmu_variable *const variable = find(own, references[i], FMU_INT16);

        status = (variable != NULL) ? write(own, variable, values[i]) : fmi3Error;
    }
    return status;
}

fmi3Status fmi3GetInt32(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                        fmi3Int32 values[], size_t nValues)
{
    const fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        if (references[i] == (fmi3ValueReference)SCAN_REFERENCE) {
            values[i] = own->state.scan_ms;
            continue;
        }
        const fmu_variable *const variable = find(own, references[i], FMU_INT32);

        if (variable == NULL) {
            status = fmi3Error;
        } else {
            values[i] = read(own, variable);
        }
    }
    return status;
}

/* Sets the scan time, which is fixed once the simulation runs. */
static fmi3Status set_scan_time(fmu_instance *instance, int32_t ms)
{
    if (instance->state.mode > FMU_INITIALIZATION) {
        return fmu_error(instance, "%s can only be set before the simulation begins", FMU_SCAN_NAME);
    }
    if ((ms < FEWEST_MS) || (ms > MOST_MS)) {
        return fmu_error(instance, "%s is 1 to 32767", FMU_SCAN_NAME);
    }
    instance->state.scan_ms = ms;
    return fmi3OK;
}

fmi3Status fmi3SetInt32(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                        const fmi3Int32 values[], size_t nValues)
{
    fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        if (references[i] == (fmi3ValueReference)SCAN_REFERENCE) {
            status = set_scan_time(own, values[i]);
            continue;
        }
        const fmu_variable *const variable = find(own, references[i], FMU_INT32);

        status = (variable != NULL) ? write(own, variable, values[i]) : fmi3Error;
    }
    return status;
}

fmi3Status fmi3GetFloat32(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                          fmi3Float32 values[], size_t nValues)
{
    const fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        const fmu_variable *const variable = find(own, references[i], FMU_FLOAT32);

        if (variable == NULL) {
            status = fmi3Error;
        } else {
            const int32_t bits = read(own, variable);
            (void)memcpy(&values[i], &bits, sizeof values[i]);
        }
    }
    return status;
}

fmi3Status fmi3SetFloat32(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                          const fmi3Float32 values[], size_t nValues)
{
    fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        const fmu_variable *const variable = find(own, references[i], FMU_FLOAT32);
        int32_t bits = 0;

        (void)memcpy(&bits, &values[i], sizeof bits);
        status = (variable != NULL) ? write(own, variable, bits) : fmi3Error;
    }
    return status;
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                          fmi3Float64 values[], size_t nValues)
{
    const fmu_instance *const own = fitting(instance, references, nReferences, values, nValues);
    fmi3Status status = (own != NULL) ? fmi3OK : fmi3Error;

    for (size_t i = 0; (i < nReferences) && (status == fmi3OK); i++) {
        if (references[i] != (fmi3ValueReference)TIME_REFERENCE) {
            status = fmu_error(own, "%s: only the time has this type", "fmi3GetFloat64");
        } else {
            values[i] = own->state.start_s + ((double)own->state.end_us / 1e6);
        }
    }
    return status;
}
