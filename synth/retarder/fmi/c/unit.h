/* What the interface (interface.c) asks of a unit: its variables, its memory, and two functions. */
#ifndef UNIT_H
#define UNIT_H

#include "fmi3.h"
#include "variables.h" /* generated: unit_values, UNIT_VARIABLES, UNIT_PERIOD_S, UNIT_TOKEN */
#include "memory.h"    /* of the unit: unit_memory, without pointers, so that a copy of it is a saved state */

#define FAULT_ROOM 256

typedef enum { UNIT_FLOAT64, UNIT_INT32, UNIT_BOOLEAN } unit_kind;
typedef enum { UNIT_INDEPENDENT, UNIT_PARAMETER, UNIT_INPUT, UNIT_OUTPUT } unit_causality;

/* A variable, and its place in unit_values; its value reference is its number in unit_variables. */
typedef struct {
    const char *name;
    unit_kind kind;
    unit_causality causality;
    size_t offset;
    size_t count;
    double low; /* limits of what is given; -HUGE_VAL and HUGE_VAL where it has none */
    double high;
} unit_variable;

extern const unit_variable unit_variables[UNIT_VARIABLES];
extern const unit_values unit_start;

/* Begin with the parameters, which keep their limits, and set the outputs at time 0. Returns 1, or 0 with the fault as a sentence. */
int unit_begin(unit_values *values, unit_memory *memory, char fault[FAULT_ROOM]);

/* Take the inputs, go on by one step, and set the outputs at its end. Returns as unit_begin. */
int unit_step(unit_values *values, unit_memory *memory, char fault[FAULT_ROOM]);

#endif
