/*
 * fmu_instance.h: an instance of the functional mock-up unit. fmu_program.h names the functions of the PLC program.
 */
#ifndef FMU_INSTANCE_H
#define FMU_INSTANCE_H

#include "fmi3Functions.h"
#include "fmu_program.h"

/* Type of a variable. */
enum { FMU_BOOLEAN, FMU_INT16, FMU_INT32, FMU_FLOAT32 };

/* A device as a variable. */
typedef struct {
    uint32_t reference; /* value reference: says which device it is, see fmi3Variables.c */
    const char *name;
    uint8_t type;
    bool input; /* an importer may set it */
} fmu_variable;

/* All of them, by their value references. */
extern const fmu_variable fmu_variables[];
extern const size_t fmu_variable_count;

/* Mode of an instance. */
typedef enum { FMU_INSTANTIATED, FMU_INITIALIZATION, FMU_STEP, FMU_TERMINATED } fmu_mode;

/* All that a run changes. It can be copied: its only pointers, those of the program to hardware, stay NULL. */
typedef struct {
    fmu_plc plc;
    double start_s;       /* start of the simulation */
    uint64_t end_us;      /* time from then to the last communication point */
    uint64_t now_ms;      /* time of the PLC */
    uint64_t scan_at_ms;  /* start of its next scan */
    int32_t scan_ms;      /* duration of a scan */
    uint32_t constant_ms; /* duration that the program asks for (M8039) */
    fmu_mode mode;
    plc_error error; /* the last one that was logged */
    bool scanned;
} fmu_state;

/* An instance. */
typedef struct {
    fmu_state state;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log_message;
    bool logs_events;
} fmu_instance;

/* Logs an error of the caller; `format` has one `%s`, for `what`. Returns fmi3Error. */
fmi3Status fmu_error(const fmu_instance *instance, const char *format, const char *what);

#endif
