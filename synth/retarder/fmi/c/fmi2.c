/* The functions of FMI 2.0 for co-simulation, by those of FMI 3.0 (interface.c). Here each variable has one value. */
#include "fmi2.h"
#include "fmi3.h"

#include <stdio.h>
#include <stdlib.h>

#define NAME_ROOM 64

#ifdef FMI2_FUNCTION_PREFIX
#define FMI2(name) FMI3_PREFIXED(FMI2_FUNCTION_PREFIX, fmi2##name)
#else
#define FMI2(name) fmi2##name
#endif

fmi3Instance FMI3(InstantiateCoSimulation)(fmi3String, fmi3String, fmi3String, bool, bool, bool, bool,
    const fmi3ValueReference[], size_t, fmi3InstanceEnvironment, fmi3LogMessageCallback, fmi3AnyCallback);
void FMI3(FreeInstance)(fmi3Instance);
fmi3Status FMI3(EnterInitializationMode)(fmi3Instance, bool, double, double, bool, double);
fmi3Status FMI3(ExitInitializationMode)(fmi3Instance);
fmi3Status FMI3(Terminate)(fmi3Instance);
fmi3Status FMI3(Reset)(fmi3Instance);
fmi3Status FMI3(DoStep)(fmi3Instance, double, double, bool, bool *, bool *, bool *, double *);

typedef struct {
    fmi3Instance inner;
    fmi2CallbackFunctions importer;
    double start_s;
    char name[NAME_ROOM];
} component;

static fmi3Instance inner(fmi2Component given)
{
    return ((component *)given)->inner;
}

/* Both versions have the same numbers for a status that a call of FMI 3.0 can have. */
static fmi2Status as_before(fmi3Status status)
{
    return (fmi2Status)status;
}

static void hand_on(fmi3InstanceEnvironment given, fmi3Status status, fmi3String category, fmi3String sentence)
{
    const component *unit = given;
    if (unit->importer.logger != 0) {
        unit->importer.logger(
            unit->importer.componentEnvironment, unit->name, as_before(status), category, "%s", sentence);
    }
}

FMI3_EXPORT const char *FMI2(GetTypesPlatform)(void)
{
    return "default";
}

FMI3_EXPORT const char *FMI2(GetVersion)(void)
{
    return "2.0";
}

FMI3_EXPORT fmi2Status FMI2(SetDebugLogging)(
    fmi2Component given, fmi2Boolean on, size_t count, const fmi2String categories[])
{
    (void)given, (void)on, (void)count, (void)categories; /* faults alone are logged, and always */
    return fmi2OK;
}

FMI3_EXPORT fmi2Component FMI2(Instantiate)(fmi2String name, fmi2Type type, fmi2String token, fmi2String resources,
    const fmi2CallbackFunctions *importer, fmi2Boolean visible, fmi2Boolean is_logging)
{
    component *unit = type == fmi2CoSimulation && importer != 0 ? calloc(1, sizeof *unit) : 0;
    (void)visible, (void)is_logging;
    if (unit == 0) {
        return 0;
    }
    unit->importer = *importer;
    snprintf(unit->name, sizeof unit->name, "%s", name == 0 ? "" : name);
    unit->inner = FMI3(InstantiateCoSimulation)(
        name, token, resources, false, false, false, false, 0, 0, unit, hand_on, 0);
    if (unit->inner == 0) {
        free(unit);
        return 0;
    }
    return unit;
}

FMI3_EXPORT void FMI2(FreeInstance)(fmi2Component given)
{
    if (given != 0) {
        FMI3(FreeInstance)(inner(given));
    }
    free(given);
}

FMI3_EXPORT fmi2Status FMI2(SetupExperiment)(fmi2Component given, fmi2Boolean has_tolerance, fmi2Real tolerance,
    fmi2Real start_s, fmi2Boolean has_end, fmi2Real end_s)
{
    (void)has_tolerance, (void)tolerance, (void)has_end, (void)end_s;
    ((component *)given)->start_s = start_s;
    return fmi2OK;
}

FMI3_EXPORT fmi2Status FMI2(EnterInitializationMode)(fmi2Component given)
{
    const component *unit = given;
    return as_before(FMI3(EnterInitializationMode)(unit->inner, false, 0.0, unit->start_s, false, 0.0));
}

FMI3_EXPORT fmi2Status FMI2(DoStep)(fmi2Component given, fmi2Real from_s, fmi2Real step_s, fmi2Boolean is_final)
{
    bool has_event, terminates, is_early;
    double reached_s;
    return as_before(FMI3(DoStep)(
        inner(given), from_s, step_s, is_final != 0, &has_event, &terminates, &is_early, &reached_s));
}

#define SAME(name)                                                                                                     \
    FMI3_EXPORT fmi2Status FMI2(name)(fmi2Component given)                                                             \
    {                                                                                                                  \
        return as_before(FMI3(name)(inner(given)));                                                                    \
    }

SAME(ExitInitializationMode)
SAME(Terminate)
SAME(Reset)

typedef fmi2ValueReference reference;

/* `type`: that of FMI 2.0, `stored`: that of FMI 3.0. One value at a time, as bool and int have other sizes. */
#define ACCESS(name, type, name_in_3, stored)                                                                          \
    fmi3Status FMI3(Get##name_in_3)(fmi3Instance, const fmi3ValueReference[], size_t, stored[], size_t);               \
    fmi3Status FMI3(Set##name_in_3)(fmi3Instance, const fmi3ValueReference[], size_t, const stored[], size_t);         \
    FMI3_EXPORT fmi2Status FMI2(Get##name)(fmi2Component given, const reference which[], size_t count, type values[])  \
    {                                                                                                                  \
        fmi3Status status = fmi3OK;                                                                                    \
        for (size_t each = 0; status == fmi3OK && each < count; ++each) {                                              \
            const fmi3ValueReference one = which[each];                                                                \
            stored value = 0;                                                                                          \
            status = FMI3(Get##name_in_3)(inner(given), &one, 1, &value, 1);                                           \
            values[each] = value;                                                                                      \
        }                                                                                                              \
        return as_before(status);                                                                                      \
    }                                                                                                                  \
    FMI3_EXPORT fmi2Status FMI2(Set##name)(                                                                            \
        fmi2Component given, const reference which[], size_t count, const type values[])                               \
    {                                                                                                                  \
        fmi3Status status = fmi3OK;                                                                                    \
        for (size_t each = 0; status == fmi3OK && each < count; ++each) {                                              \
            const fmi3ValueReference one = which[each];                                                                \
            const stored value = values[each];                                                                         \
            status = FMI3(Set##name_in_3)(inner(given), &one, 1, &value, 1);                                           \
        }                                                                                                              \
        return as_before(status);                                                                                      \
    }

ACCESS(Real, fmi2Real, Float64, fmi3Float64)
ACCESS(Integer, fmi2Integer, Int32, fmi3Int32)
ACCESS(Boolean, fmi2Boolean, Boolean, fmi3Boolean)

#define NOT_OFFERED(name, ...)                                                                                         \
    FMI3_EXPORT fmi2Status FMI2(name)(__VA_ARGS__)                                                                     \
    {                                                                                                                  \
        return fmi2Error;                                                                                              \
    }

NOT_OFFERED(GetString, fmi2Component unit, const reference which[], size_t count, fmi2String values[])
NOT_OFFERED(SetString, fmi2Component unit, const reference which[], size_t count, const fmi2String values[])
NOT_OFFERED(GetFMUstate, fmi2Component unit, fmi2FMUstate *state)
NOT_OFFERED(SetFMUstate, fmi2Component unit, fmi2FMUstate state)
NOT_OFFERED(FreeFMUstate, fmi2Component unit, fmi2FMUstate *state)
NOT_OFFERED(SerializedFMUstateSize, fmi2Component unit, fmi2FMUstate state, size_t *size)
NOT_OFFERED(SerializeFMUstate, fmi2Component unit, fmi2FMUstate state, fmi2Byte bytes[], size_t size)
NOT_OFFERED(DeSerializeFMUstate, fmi2Component unit, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state)
NOT_OFFERED(GetDirectionalDerivative, fmi2Component unit, const reference unknowns[], size_t unknown_count,
    const reference knowns[], size_t known_count, const fmi2Real seed[], fmi2Real found[])
NOT_OFFERED(SetRealInputDerivatives, fmi2Component unit, const reference which[], size_t count,
    const fmi2Integer orders[], const fmi2Real values[])
NOT_OFFERED(GetRealOutputDerivatives, fmi2Component unit, const reference which[], size_t count,
    const fmi2Integer orders[], fmi2Real values[])
NOT_OFFERED(CancelStep, fmi2Component unit)
NOT_OFFERED(GetStatus, fmi2Component unit, const fmi2StatusKind kind, fmi2Status *value)
NOT_OFFERED(GetRealStatus, fmi2Component unit, const fmi2StatusKind kind, fmi2Real *value)
NOT_OFFERED(GetIntegerStatus, fmi2Component unit, const fmi2StatusKind kind, fmi2Integer *value)
NOT_OFFERED(GetBooleanStatus, fmi2Component unit, const fmi2StatusKind kind, fmi2Boolean *value)
NOT_OFFERED(GetStringStatus, fmi2Component unit, const fmi2StatusKind kind, fmi2String *value)
