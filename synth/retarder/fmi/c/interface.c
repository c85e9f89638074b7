/* The functions of FMI 3.0 for co-simulation: they keep the values of the variables and call the unit (unit.h). */
#include "unit.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define STEP_TOLERANCE 1e-6 /* of a step, relative: steps in decimal are no exact numbers */

typedef enum { INSTANTIATED, INITIALISING, STEPPING, TERMINATED } life;

/* All that a saved state holds. */
typedef struct {
    life life;
    int is_begun; /* whether unit_begin has seen the parameters as they are */
    unit_values values;
    unit_memory memory;
} moment;

typedef struct {
    moment now;
    fmi3InstanceEnvironment environment;
    fmi3LogMessageCallback log;
} instance;

static const size_t SIZES[] = {sizeof(fmi3Float64), sizeof(fmi3Int32), sizeof(fmi3Boolean)};

static fmi3Status refused(instance *unit, const char *sentence, ...)
{
    char text[FAULT_ROOM];
    va_list given;
    va_start(given, sentence);
    vsnprintf(text, sizeof text, sentence, given);
    va_end(given);
    if (unit->log != 0) {
        unit->log(unit->environment, fmi3Error, "logStatusError", text);
    }
    return fmi3Error;
}

static void forget(instance *unit)
{
    memset(&unit->now, 0, sizeof unit->now);
    unit->now.values = unit_start;
}

static double number_at(const unit_values *values, const unit_variable *variable, size_t place)
{
    const unsigned char *at = (const unsigned char *)values + variable->offset + place * SIZES[variable->kind];
    int32_t whole;
    double number;
    if (variable->kind == UNIT_INT32) {
        memcpy(&whole, at, sizeof whole);
        return whole;
    }
    memcpy(&number, at, sizeof number);
    return number;
}

/* Whether all that is given of this causality keeps its limits, in which NaN does not lie. */
static fmi3Status within_limits(instance *unit, unit_causality causality)
{
    for (size_t each = 0; each < UNIT_VARIABLES; ++each) {
        const unit_variable *variable = &unit_variables[each];
        const int has_limits = variable->low > -HUGE_VAL || variable->high < HUGE_VAL;
        for (size_t place = 0; has_limits && variable->causality == causality && place < variable->count; ++place) {
            const double number = number_at(&unit->now.values, variable, place);
            if (!(number >= variable->low && number <= variable->high)) {
                return refused(unit, "%s is %g; give %g to %g", variable->name, number, variable->low, variable->high);
            }
        }
    }
    return fmi3OK;
}

static fmi3Status begun(instance *unit)
{
    char fault[FAULT_ROOM] = "";
    if (unit->now.is_begun) {
        return fmi3OK;
    }
    if (within_limits(unit, UNIT_PARAMETER) != fmi3OK) {
        return fmi3Error;
    }
    memset(&unit->now.memory, 0, sizeof unit->now.memory);
    if (!unit_begin(&unit->now.values, &unit->now.memory, fault)) {
        return refused(unit, "%s", fault);
    }
    unit->now.is_begun = 1;
    return fmi3OK;
}

static const unit_variable *variable_of(fmi3ValueReference reference, unit_kind kind)
{
    const int is_there = reference < UNIT_VARIABLES && unit_variables[reference].kind == kind;
    return is_there ? &unit_variables[reference] : 0;
}

static fmi3Status get(
    fmi3Instance given, unit_kind kind, const fmi3ValueReference references[], size_t count, void *values, size_t room)
{
    instance *unit = given;
    unsigned char *to = values;
    size_t taken = 0;
    /* While it is initialised, outputs follow the parameters at once. */
    if (unit->now.life == INITIALISING && begun(unit) != fmi3OK) {
        return fmi3Error;
    }
    for (size_t each = 0; each < count; ++each) {
        const unit_variable *variable = variable_of(references[each], kind);
        if (variable == 0 || taken + variable->count > room) {
            return refused(unit, "get: no variable of this type and length has the value reference %u",
                (unsigned)references[each]);
        }
        memcpy(to + taken * SIZES[kind], (const unsigned char *)&unit->now.values + variable->offset,
            variable->count * SIZES[kind]);
        taken += variable->count;
    }
    return fmi3OK;
}

static int may_set(const instance *unit, unit_causality causality)
{
    const int is_early = unit->now.life == INSTANTIATED || unit->now.life == INITIALISING;
    return (causality == UNIT_INPUT && unit->now.life != TERMINATED) || (causality == UNIT_PARAMETER && is_early);
}

static fmi3Status set(fmi3Instance given, unit_kind kind, const fmi3ValueReference references[], size_t count,
    const void *values, size_t room)
{
    instance *unit = given;
    const unsigned char *from = values;
    size_t taken = 0;
    for (size_t each = 0; each < count; ++each) {
        const unit_variable *variable = variable_of(references[each], kind);
        if (variable == 0 || taken + variable->count > room || !may_set(unit, variable->causality)) {
            return refused(unit, "set: the variable with the value reference %u cannot be set so, or not now",
                (unsigned)references[each]);
        }
        memcpy((unsigned char *)&unit->now.values + variable->offset, from + taken * SIZES[kind],
            variable->count * SIZES[kind]);
        taken += variable->count;
        if (variable->causality == UNIT_PARAMETER) {
            unit->now.is_begun = 0;
        }
    }
    return fmi3OK;
}

static fmi3Status lives_on(fmi3Instance given, life from, life to, const char *what)
{
    instance *unit = given;
    if (unit->now.life != from) {
        return refused(unit, "%s: it is not the time for this call", what);
    }
    unit->now.life = to;
    return fmi3OK;
}

FMI3_EXPORT const char *FMI3(GetVersion)(void)
{
    return "3.0";
}

FMI3_EXPORT fmi3Status FMI3(SetDebugLogging)(fmi3Instance given, bool on, size_t count, const fmi3String categories[])
{
    (void)given, (void)on, (void)count, (void)categories; /* faults alone are logged, and always */
    return fmi3OK;
}

FMI3_EXPORT fmi3Instance FMI3(InstantiateCoSimulation)(fmi3String name, fmi3String token, fmi3String resources,
    bool visible, bool is_logging, bool has_events, bool returns_early, const fmi3ValueReference intermediate[],
    size_t count, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3AnyCallback update)
{
    instance *unit = calloc(1, sizeof *unit);
    (void)name, (void)resources, (void)visible, (void)is_logging, (void)returns_early, (void)intermediate;
    (void)update;
    if (unit == 0) {
        return 0;
    }
    unit->environment = environment;
    unit->log = log;
    forget(unit);
    if (token == 0 || strcmp(token, UNIT_TOKEN) != 0) {
        refused(unit, "instantiate: the token is not that of this unit; its modelDescription.xml is of another");
    } else if (has_events || count > 0) {
        refused(unit, "instantiate: this unit has neither events nor intermediate variables");
    } else {
        return unit;
    }
    free(unit);
    return 0;
}

FMI3_EXPORT void FMI3(FreeInstance)(fmi3Instance given)
{
    free(given);
}

FMI3_EXPORT fmi3Status FMI3(EnterInitializationMode)(
    fmi3Instance given, bool has_tolerance, double tolerance, double start_s, bool has_end, double end_s)
{
    (void)has_tolerance, (void)tolerance, (void)has_end, (void)end_s;
    ((instance *)given)->now.values.time_s = start_s;
    return lives_on(given, INSTANTIATED, INITIALISING, "EnterInitializationMode");
}

FMI3_EXPORT fmi3Status FMI3(ExitInitializationMode)(fmi3Instance given)
{
    if (begun(given) != fmi3OK) {
        return fmi3Error;
    }
    return lives_on(given, INITIALISING, STEPPING, "ExitInitializationMode");
}

FMI3_EXPORT fmi3Status FMI3(EnterStepMode)(fmi3Instance given)
{
    return lives_on(given, STEPPING, STEPPING, "EnterStepMode");
}

FMI3_EXPORT fmi3Status FMI3(Terminate)(fmi3Instance given)
{
    return lives_on(given, STEPPING, TERMINATED, "Terminate");
}

FMI3_EXPORT fmi3Status FMI3(Reset)(fmi3Instance given)
{
    forget(given);
    return fmi3OK;
}

/* How many steps of the unit a step of the importer is; 0: none, or not a whole number. */
static long steps_in(double step_s)
{
    const double many = UNIT_PERIOD_S > 0.0 ? step_s / UNIT_PERIOD_S : 1.0;
    const double whole = floor(many + 0.5);
    if (!(step_s > 0.0) || !(whole >= 1.0 && whole <= 1e6) || fabs(many - whole) > STEP_TOLERANCE * whole) {
        return 0;
    }
    return (long)whole;
}

FMI3_EXPORT fmi3Status FMI3(DoStep)(fmi3Instance given, double from_s, double step_s, bool is_final, bool *has_event,
    bool *terminates, bool *is_early, double *reached_s)
{
    instance *unit = given;
    const long count = steps_in(step_s);
    (void)is_final;
    *has_event = *terminates = *is_early = false;
    *reached_s = from_s;
    if (unit->now.life != STEPPING) {
        return refused(unit, "DoStep: the unit is not initialised, or has been terminated");
    }
    if (count == 0) {
        return refused(unit, "DoStep: the step is %g s; it must be a whole number of times %g s", step_s,
            UNIT_PERIOD_S);
    }
    if (within_limits(unit, UNIT_INPUT) != fmi3OK) {
        return fmi3Error;
    }
    for (long each = 0; each < count; ++each) {
        char fault[FAULT_ROOM] = "";
        if (!unit_step(&unit->now.values, &unit->now.memory, fault)) {
            return refused(unit, "%s", fault);
        }
    }
    unit->now.values.time_s = *reached_s = from_s + step_s;
    return fmi3OK;
}

#define ACCESS(name, type, kind)                                                                                       \
    FMI3_EXPORT fmi3Status FMI3(Get##name)(                                                                            \
        fmi3Instance given, const fmi3ValueReference references[], size_t count, type values[], size_t room)           \
    {                                                                                                                  \
        return get(given, kind, references, count, values, room);                                                     \
    }                                                                                                                  \
    FMI3_EXPORT fmi3Status FMI3(Set##name)(                                                                            \
        fmi3Instance given, const fmi3ValueReference references[], size_t count, const type values[], size_t room)     \
    {                                                                                                                  \
        return set(given, kind, references, count, values, room);                                                     \
    }

ACCESS(Float64, fmi3Float64, UNIT_FLOAT64)
ACCESS(Int32, fmi3Int32, UNIT_INT32)
ACCESS(Boolean, fmi3Boolean, UNIT_BOOLEAN)

FMI3_EXPORT fmi3Status FMI3(GetFMUState)(fmi3Instance given, fmi3FMUState *state)
{
    if (*state == 0) {
        *state = malloc(sizeof(moment));
    }
    if (*state == 0) {
        return refused(given, "GetFMUState: there is no memory");
    }
    memcpy(*state, &((instance *)given)->now, sizeof(moment));
    return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3(SetFMUState)(fmi3Instance given, fmi3FMUState state)
{
    memcpy(&((instance *)given)->now, state, sizeof(moment));
    return fmi3OK;
}

FMI3_EXPORT fmi3Status FMI3(FreeFMUState)(fmi3Instance given, fmi3FMUState *state)
{
    (void)given;
    free(*state);
    *state = 0;
    return fmi3OK;
}
