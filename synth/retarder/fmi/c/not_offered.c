/* The functions of FMI 3.0 that these units must have and do not offer: other types, clocks, derivatives, events. */
#include "fmi3.h"

#define ANSWER(name, ...)                                                                                              \
    FMI3_EXPORT fmi3Status FMI3(name)(__VA_ARGS__)                                                                     \
    {                                                                                                                  \
        return fmi3Error;                                                                                              \
    }

/* To ask for none of their variables is no fault. */
#define NO_VARIABLES(name, type)                                                                                       \
    FMI3_EXPORT fmi3Status FMI3(Get##name)(                                                                            \
        fmi3Instance unit, const fmi3ValueReference references[], size_t count, type values[], size_t room)            \
    {                                                                                                                  \
        return count == 0 ? fmi3OK : fmi3Error;                                                                        \
    }                                                                                                                  \
    FMI3_EXPORT fmi3Status FMI3(Set##name)(                                                                            \
        fmi3Instance unit, const fmi3ValueReference references[], size_t count, const type values[], size_t room)      \
    {                                                                                                                  \
        return count == 0 ? fmi3OK : fmi3Error;                                                                        \
    }

NO_VARIABLES(Float32, fmi3Float32)
NO_VARIABLES(Int8, fmi3Int8)
NO_VARIABLES(UInt8, fmi3UInt8)
NO_VARIABLES(Int16, fmi3Int16)
NO_VARIABLES(UInt16, fmi3UInt16)
NO_VARIABLES(UInt32, fmi3UInt32)
NO_VARIABLES(Int64, fmi3Int64)
NO_VARIABLES(UInt64, fmi3UInt64)
NO_VARIABLES(String, fmi3String)

typedef fmi3ValueReference reference;

ANSWER(GetBinary, fmi3Instance unit, const reference which[], size_t count, size_t sizes[], fmi3Binary values[],
    size_t room)
ANSWER(SetBinary, fmi3Instance unit, const reference which[], size_t count, const size_t sizes[],
    const fmi3Binary values[], size_t room)
ANSWER(GetClock, fmi3Instance unit, const reference which[], size_t count, fmi3Clock values[])
ANSWER(SetClock, fmi3Instance unit, const reference which[], size_t count, const fmi3Clock values[])

FMI3_EXPORT fmi3Instance FMI3(InstantiateModelExchange)(fmi3String name, fmi3String token, fmi3String resources,
    bool visible, bool logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log)
{
    return 0;
}

FMI3_EXPORT fmi3Instance FMI3(InstantiateScheduledExecution)(fmi3String name, fmi3String token, fmi3String resources,
    bool visible, bool logging, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3AnyCallback update, fmi3AnyCallback lock, fmi3AnyCallback unlock)
{
    return 0;
}

ANSWER(EnterEventMode, fmi3Instance unit)
ANSWER(EnterConfigurationMode, fmi3Instance unit)
ANSWER(ExitConfigurationMode, fmi3Instance unit)
ANSWER(EvaluateDiscreteStates, fmi3Instance unit)
ANSWER(UpdateDiscreteStates, fmi3Instance unit, bool *needed, bool *terminates, bool *nominals, bool *values,
    bool *has_next, double *next_s)
ANSWER(GetNumberOfVariableDependencies, fmi3Instance unit, reference which, size_t *count)
ANSWER(GetVariableDependencies, fmi3Instance unit, reference dependent, size_t elements[], reference independents[],
    size_t others[], fmi3DependencyKind kinds[], size_t count)
ANSWER(GetDirectionalDerivative, fmi3Instance unit, const reference unknowns[], size_t unknown_count,
    const reference knowns[], size_t known_count, const double seed[], size_t seeds, double found[], size_t room)
ANSWER(GetAdjointDerivative, fmi3Instance unit, const reference unknowns[], size_t unknown_count,
    const reference knowns[], size_t known_count, const double seed[], size_t seeds, double found[], size_t room)
ANSWER(GetOutputDerivatives, fmi3Instance unit, const reference which[], size_t count, const fmi3Int32 orders[],
    double values[], size_t room)
ANSWER(SerializedFMUStateSize, fmi3Instance unit, fmi3FMUState state, size_t *size)
ANSWER(SerializeFMUState, fmi3Instance unit, fmi3FMUState state, fmi3Byte bytes[], size_t size)
ANSWER(DeserializeFMUState, fmi3Instance unit, const fmi3Byte bytes[], size_t size, fmi3FMUState *state)
ANSWER(GetIntervalDecimal, fmi3Instance unit, const reference which[], size_t count, double intervals[],
    fmi3IntervalQualifier qualifiers[])
ANSWER(GetIntervalFraction, fmi3Instance unit, const reference which[], size_t count, fmi3UInt64 counters[],
    fmi3UInt64 resolutions[], fmi3IntervalQualifier qualifiers[])
ANSWER(GetShiftDecimal, fmi3Instance unit, const reference which[], size_t count, double shifts[])
ANSWER(GetShiftFraction, fmi3Instance unit, const reference which[], size_t count, fmi3UInt64 counters[],
    fmi3UInt64 resolutions[])
ANSWER(SetIntervalDecimal, fmi3Instance unit, const reference which[], size_t count, const double intervals[])
ANSWER(SetIntervalFraction, fmi3Instance unit, const reference which[], size_t count, const fmi3UInt64 counters[],
    const fmi3UInt64 resolutions[])
ANSWER(SetShiftDecimal, fmi3Instance unit, const reference which[], size_t count, const double shifts[])
ANSWER(SetShiftFraction, fmi3Instance unit, const reference which[], size_t count, const fmi3UInt64 counters[],
    const fmi3UInt64 resolutions[])

/* Of the other interfaces; importers that load every function at once need them. */
ANSWER(EnterContinuousTimeMode, fmi3Instance unit)
ANSWER(CompletedIntegratorStep, fmi3Instance unit, bool is_final, bool *has_event, bool *terminates)
ANSWER(SetTime, fmi3Instance unit, double time_s)
ANSWER(SetContinuousStates, fmi3Instance unit, const double states[], size_t count)
ANSWER(GetContinuousStates, fmi3Instance unit, double states[], size_t count)
ANSWER(GetContinuousStateDerivatives, fmi3Instance unit, double derivatives[], size_t count)
ANSWER(GetNominalsOfContinuousStates, fmi3Instance unit, double nominals[], size_t count)
ANSWER(GetNumberOfContinuousStates, fmi3Instance unit, size_t *count)
ANSWER(GetEventIndicators, fmi3Instance unit, double indicators[], size_t count)
ANSWER(GetNumberOfEventIndicators, fmi3Instance unit, size_t *count)
ANSWER(ActivateModelPartition, fmi3Instance unit, reference clock, double time_s)
