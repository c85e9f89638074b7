/* The controller as a unit: one step is one sample of the radar. It decides at the beginning of the step. */
#include "unit.h"

#include <stdio.h>

int unit_begin(unit_values *values, unit_memory *memory, char fault[FAULT_ROOM])
{
    values->choice = retarder_select(
        values->category, values->axles, (float)values->commanded_m_s, &memory->table);
    if (values->choice < 0) {
        snprintf(fault, FAULT_ROOM,
            "there is no table for category %d, %d axles and %g m/s (choice %d): set category, axles and commanded_m_s",
            (int)values->category, (int)values->axles, values->commanded_m_s, (int)values->choice);
        return 0;
    }
    if (!retarder_table_intact(&memory->table)) {
        snprintf(fault, FAULT_ROOM, "the checksum of the table is wrong: export the unit again");
        return 0;
    }
    if (values->initial_stage < 0 || values->initial_stage >= memory->table.stages) {
        snprintf(fault, FAULT_ROOM, "initial_stage is %d; the table has the stages 0 to %d",
            (int)values->initial_stage, (int)memory->table.stages - 1);
        return 0;
    }
    retarder_begin(&memory->estimate);
    values->stage = values->initial_stage;
    values->speed_m_s = -1.0;
    values->alarms = 0;
    values->unseen = 0;
    return 1;
}

int unit_step(unit_values *values, unit_memory *memory, char fault[FAULT_ROOM])
{
    const float path_m = (float)values->path_m;
    const float speed_m_s = retarder_observe(&memory->table, &memory->estimate, path_m, (float)values->measured_m_s,
        (float)values->mean_overpressure_kpa);
    (void)fault;
    if (values->at_rest || memory->table.at_any_time) {
        values->stage = retarder_decide(
            &memory->table, values->stage, path_m, speed_m_s, (float)values->pressure_kpa);
    }
    values->speed_m_s = speed_m_s;
    values->alarms = retarder_alarms(&memory->table, &memory->estimate);
    values->unseen = (int32_t)memory->estimate.unseen;
    return 1;
}
