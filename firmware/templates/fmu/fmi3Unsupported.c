/*
 * fmi3Unsupported.c: functions of FMI 3.0 that this unit does not support: they log this and return fmi3Error.
 */
#include "fmu_instance.h"

/* The function is not available. */
static fmi3Status unsupported(fmi3Instance instance, const char *function)
{
    return fmu_error(instance, "%s is not supported by this FMU", function);
}

/* No variable has the type of the function; none is asked for if the list is empty. */
static fmi3Status no_variable(fmi3Instance instance, size_t count, const char *function)
{
    if ((instance != NULL) && (count == 0u)) {
        return fmi3OK;
    }
    return fmu_error(instance, "%s: no variable has this type", function);
}

#define GETTER(NAME)                                                                                                   \
    fmi3Status fmi3Get##NAME(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,         \
                             fmi3##NAME values[], size_t nValues)                                                      \
    {                                                                                                                  \
        (void)references;                                                                                              \
        (void)values;                                                                                                  \
        (void)nValues;                                                                                                 \
        return no_variable(instance, nReferences, "fmi3Get" #NAME);                                                    \
    }

#define SETTER(NAME)                                                                                                   \
    fmi3Status fmi3Set##NAME(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,         \
                             const fmi3##NAME values[], size_t nValues)                                                \
    {                                                                                                                  \
        (void)references;                                                                                              \
        (void)values;                                                                                                  \
        (void)nValues;                                                                                                 \
        return no_variable(instance, nReferences, "fmi3Set" #NAME);                                                    \
    }

GETTER(Int8)
SETTER(Int8)
GETTER(UInt8)
SETTER(UInt8)
GETTER(UInt16)
SETTER(UInt16)
GETTER(UInt32)
SETTER(UInt32)
GETTER(Int64)
SETTER(Int64)
GETTER(UInt64)
SETTER(UInt64)
SETTER(Float64)
GETTER(String)
SETTER(String)

fmi3Instance fmi3InstantiateModelExchange(fmi3String name, fmi3String token, fmi3String resourcePath,
                                          fmi3Boolean visible, fmi3Boolean loggingOn,
                                          fmi3InstanceEnvironment environment, fmi3LogMessageCallback logMessage)
{
    fmu_instance draft;

    (void)memset(&draft, 0, sizeof draft);
    (void)name;
    (void)token;
    (void)resourcePath;
    (void)visible;
    (void)loggingOn;
    draft.environment = environment;
    draft.log_message = logMessage;
    (void)unsupported(&draft, "fmi3InstantiateModelExchange");
    return NULL;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String name, fmi3String token, fmi3String resourcePath,
                                               fmi3Boolean visible, fmi3Boolean loggingOn,
                                               fmi3InstanceEnvironment environment, fmi3LogMessageCallback logMessage,
                                               fmi3ClockUpdateCallback clockUpdate,
                                               fmi3LockPreemptionCallback lockPreemption,
                                               fmi3UnlockPreemptionCallback unlockPreemption)
{
    fmu_instance draft;

    (void)memset(&draft, 0, sizeof draft);
    (void)name;
    (void)token;
    (void)resourcePath;
    (void)visible;
    (void)loggingOn;
    (void)clockUpdate;
    (void)lockPreemption;
    (void)unlockPreemption;
    draft.environment = environment;
    draft.log_message = logMessage;
    (void)unsupported(&draft, "fmi3InstantiateScheduledExecution");
    return NULL;
}

fmi3Status fmi3EnterEventMode(fmi3Instance instance)
{
    return unsupported(instance, "fmi3EnterEventMode");
}

fmi3Status fmi3EnterStepMode(fmi3Instance instance)
{
    return unsupported(instance, "fmi3EnterStepMode");
}

fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance instance)
{
    return unsupported(instance, "fmi3EnterContinuousTimeMode");
}

fmi3Status fmi3EnterConfigurationMode(fmi3Instance instance)
{
    return unsupported(instance, "fmi3EnterConfigurationMode");
}

fmi3Status fmi3ExitConfigurationMode(fmi3Instance instance)
{
    return unsupported(instance, "fmi3ExitConfigurationMode");
}

fmi3Status fmi3GetBinary(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                         size_t sizes[], fmi3Binary values[], size_t nValues)
{
    (void)references;
    (void)sizes;
    (void)values;
    (void)nValues;
    return no_variable(instance, nReferences, "fmi3GetBinary");
}

fmi3Status fmi3SetBinary(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                         const size_t sizes[], const fmi3Binary values[], size_t nValues)
{
    (void)references;
    (void)sizes;
    (void)values;
    (void)nValues;
    return no_variable(instance, nReferences, "fmi3SetBinary");
}

fmi3Status fmi3GetClock(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                        fmi3Clock values[])
{
    (void)references;
    (void)values;
    return no_variable(instance, nReferences, "fmi3GetClock");
}

fmi3Status fmi3SetClock(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                        const fmi3Clock values[])
{
    (void)references;
    (void)values;
    return no_variable(instance, nReferences, "fmi3SetClock");
}

fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance instance, fmi3ValueReference reference,
                                               size_t *nDependencies)
{
    (void)reference;
    (void)nDependencies;
    return unsupported(instance, "fmi3GetNumberOfVariableDependencies");
}

fmi3Status fmi3GetVariableDependencies(fmi3Instance instance, fmi3ValueReference dependent,
                                       size_t elementIndicesOfDependent[], fmi3ValueReference independents[],
                                       size_t elementIndicesOfIndependents[], fmi3DependencyKind dependencyKinds[],
                                       size_t nDependencies)
{
    (void)dependent;
    (void)elementIndicesOfDependent;
    (void)independents;
    (void)elementIndicesOfIndependents;
    (void)dependencyKinds;
    (void)nDependencies;
    return unsupported(instance, "fmi3GetVariableDependencies");
}

fmi3Status fmi3GetDirectionalDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                        const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                        size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity)
{
    (void)unknowns;
    (void)nUnknowns;
    (void)knowns;
    (void)nKnowns;
    (void)seed;
    (void)nSeed;
    (void)sensitivity;
    (void)nSensitivity;
    return unsupported(instance, "fmi3GetDirectionalDerivative");
}

fmi3Status fmi3GetAdjointDerivative(fmi3Instance instance, const fmi3ValueReference unknowns[], size_t nUnknowns,
                                    const fmi3ValueReference knowns[], size_t nKnowns, const fmi3Float64 seed[],
                                    size_t nSeed, fmi3Float64 sensitivity[], size_t nSensitivity)
{
    (void)unknowns;
    (void)nUnknowns;
    (void)knowns;
    (void)nKnowns;
    (void)seed;
    (void)nSeed;
    (void)sensitivity;
    (void)nSensitivity;
    return unsupported(instance, "fmi3GetAdjointDerivative");
}

fmi3Status fmi3GetOutputDerivatives(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                    const fmi3Int32 orders[], fmi3Float64 values[], size_t nValues)
{
    (void)references;
    (void)nReferences;
    (void)orders;
    (void)values;
    (void)nValues;
    return unsupported(instance, "fmi3GetOutputDerivatives");
}

fmi3Status fmi3GetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                  fmi3Float64 intervals[], fmi3IntervalQualifier qualifiers[])
{
    (void)references;
    (void)nReferences;
    (void)intervals;
    (void)qualifiers;
    return unsupported(instance, "fmi3GetIntervalDecimal");
}

fmi3Status fmi3GetIntervalFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                   fmi3UInt64 counters[], fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
{
    (void)references;
    (void)nReferences;
    (void)counters;
    (void)resolutions;
    (void)qualifiers;
    return unsupported(instance, "fmi3GetIntervalFraction");
}

fmi3Status fmi3GetShiftDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                               fmi3Float64 shifts[])
{
    (void)references;
    (void)nReferences;
    (void)shifts;
    return unsupported(instance, "fmi3GetShiftDecimal");
}

fmi3Status fmi3GetShiftFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                fmi3UInt64 counters[], fmi3UInt64 resolutions[])
{
    (void)references;
    (void)nReferences;
    (void)counters;
    (void)resolutions;
    return unsupported(instance, "fmi3GetShiftFraction");
}

fmi3Status fmi3SetIntervalDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                  const fmi3Float64 intervals[])
{
    (void)references;
    (void)nReferences;
    (void)intervals;
    return unsupported(instance, "fmi3SetIntervalDecimal");
}

fmi3Status fmi3SetIntervalFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                   const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)references;
    (void)nReferences;
    (void)counters;
    (void)resolutions;
    return unsupported(instance, "fmi3SetIntervalFraction");
}

fmi3Status fmi3SetShiftDecimal(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                               const fmi3Float64 shifts[])
{
    (void)references;
    (void)nReferences;
    (void)shifts;
    return unsupported(instance, "fmi3SetShiftDecimal");
}

fmi3Status fmi3SetShiftFraction(fmi3Instance instance, const fmi3ValueReference references[], size_t nReferences,
                                const fmi3UInt64 counters[], const fmi3UInt64 resolutions[])
{
    (void)references;
    (void)nReferences;
    (void)counters;
    (void)resolutions;
    return unsupported(instance, "fmi3SetShiftFraction");
}

fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance instance)
{
    return unsupported(instance, "fmi3EvaluateDiscreteStates");
}

fmi3Status fmi3UpdateDiscreteStates(fmi3Instance instance, fmi3Boolean *discreteStatesNeedUpdate,
                                    fmi3Boolean *terminateSimulation, fmi3Boolean *nominalsOfContinuousStatesChanged,
                                    fmi3Boolean *valuesOfContinuousStatesChanged, fmi3Boolean *nextEventTimeDefined,
                                    fmi3Float64 *nextEventTime)
{
    (void)discreteStatesNeedUpdate;
    (void)terminateSimulation;
    (void)nominalsOfContinuousStatesChanged;
    (void)valuesOfContinuousStatesChanged;
    (void)nextEventTimeDefined;
    (void)nextEventTime;
    return unsupported(instance, "fmi3UpdateDiscreteStates");
}

fmi3Status fmi3CompletedIntegratorStep(fmi3Instance instance, fmi3Boolean noSetFMUStatePriorToCurrentPoint,
                                       fmi3Boolean *enterEventMode, fmi3Boolean *terminateSimulation)
{
    (void)noSetFMUStatePriorToCurrentPoint;
    (void)enterEventMode;
    (void)terminateSimulation;
    return unsupported(instance, "fmi3CompletedIntegratorStep");
}

fmi3Status fmi3SetTime(fmi3Instance instance, fmi3Float64 time)
{
    (void)time;
    return unsupported(instance, "fmi3SetTime");
}

fmi3Status fmi3SetContinuousStates(fmi3Instance instance, const fmi3Float64 states[], size_t nStates)
{
    (void)states;
    (void)nStates;
    return unsupported(instance, "fmi3SetContinuousStates");
}

fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance instance, fmi3Float64 derivatives[], size_t nStates)
{
    (void)derivatives;
    (void)nStates;
    return unsupported(instance, "fmi3GetContinuousStateDerivatives");
}

fmi3Status fmi3GetEventIndicators(fmi3Instance instance, fmi3Float64 indicators[], size_t nIndicators)
{
    (void)indicators;
    (void)nIndicators;
    return unsupported(instance, "fmi3GetEventIndicators");
}

fmi3Status fmi3GetContinuousStates(fmi3Instance instance, fmi3Float64 states[], size_t nStates)
{
    (void)states;
    (void)nStates;
    return unsupported(instance, "fmi3GetContinuousStates");
}

fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance instance, fmi3Float64 nominals[], size_t nStates)
{
    (void)nominals;
    (void)nStates;
    return unsupported(instance, "fmi3GetNominalsOfContinuousStates");
}

fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance instance, size_t *nIndicators)
{
    (void)nIndicators;
    return unsupported(instance, "fmi3GetNumberOfEventIndicators");
}

fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance instance, size_t *nStates)
{
    (void)nStates;
    return unsupported(instance, "fmi3GetNumberOfContinuousStates");
}

fmi3Status fmi3ActivateModelPartition(fmi3Instance instance, fmi3ValueReference clock, fmi3Float64 activationTime)
{
    (void)clock;
    (void)activationTime;
    return unsupported(instance, "fmi3ActivateModelPartition");
}
