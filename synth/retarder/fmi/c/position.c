/* The retarder position as a unit: drive, pads, motion of the cut, radar. One step is one sampling period. */
#include "position.h"

#include <math.h>
#include <stdio.h>

enum { MOVING, LEFT, STANDS };

static void show(unit_values *values, const unit_memory *memory, double mean_kpa)
{
    values->path_m = memory->s_m;
    values->speed_m_s = memory->v_m_s;
    values->measured_m_s = reading_m_s(values, &memory->readings, memory->sample, memory->v_m_s);
    values->pressure_kpa = memory->drive.pressure_kpa;
    values->mean_overpressure_kpa = mean_kpa;
    values->at_rest = drive_rests(&memory->drive) != 0;
    values->reached_stage = values->at_rest ? memory->drive.stage : -1;
}

/* Move for a time under constant overpressure: exact, for the acceleration is constant within a cell. */
static void advance(unit_values *values, unit_memory *memory, double over_kpa, double time_s, double begin_s)
{
    const position_path *path = &memory->path;
    double left_s = time_s;
    while (values->end == MOVING) {
        const double v = memory->v_m_s, gap = path->edge_m[memory->cell + 1] - memory->s_m;
        const double a = path->gravity_m_s2[memory->cell] - path->drag_m_s2
            - path->brake_m_s2_per_kpa[memory->cell] * over_kpa;
        const double v_end = v + a * left_s, way = 0.5 * (v + v_end) * left_s;
        if (v_end > 0.0 && way < gap) {
            memory->s_m += way;
            memory->v_m_s = v_end;
            return;
        }
        const double square = v * v + 2.0 * a * gap;
        if (square <= 0.0) {
            memory->s_m -= 0.5 * v * v / a;
            left_s += v / a;
            memory->v_m_s = 0.0;
            values->end = STANDS;
        } else {
            memory->v_m_s = sqrt(square);
            left_s = fmax(0.0, left_s - 2.0 * gap / (v + memory->v_m_s));
            memory->s_m = path->edge_m[++memory->cell];
            values->end = memory->cell == path->cells ? LEFT : MOVING;
        }
        if (values->end != MOVING) {
            values->exit_speed_m_s = memory->v_m_s;
            values->pass_s = begin_s + time_s - left_s;
        }
    }
}

static int stand_in_order(const unit_values *values, char fault[FAULT_ROOM])
{
    for (int axle = 0; axle < values->axles; ++axle) {
        const double offset = values->axle_offsets_m[axle];
        if (axle == 0 ? offset != 0.0 : offset <= values->axle_offsets_m[axle - 1]) {
            snprintf(fault, FAULT_ROOM, "axle_offsets_m[%d] is %g; the first must be 0, and each further one larger",
                axle, offset);
            return 0;
        }
    }
    return 1;
}

int unit_begin(unit_values *values, unit_memory *memory, char fault[FAULT_ROOM])
{
    if (!stand_in_order(values, fault)) {
        return 0;
    }
    path_of_cut(values, &memory->path);
    vary_pads(values, &memory->path);
    draw_readings(values, &memory->readings);
    memory->s_m = memory->path.edge_m[0];
    memory->v_m_s = speed_at_begin(&memory->path, values->entry_speed_m_s);
    memory->drive.stage = values->initial_stage;
    memory->drive.pressure_kpa = RESTING_KPA[values->initial_stage];
    memory->since_begin_s = values->first_sample_s;
    values->end = MOVING;
    values->exit_speed_m_s = values->pass_s = 0.0;
    const double over_kpa = fmax(0.0, memory->drive.pressure_kpa - TOUCH_KPA);
    advance(values, memory, over_kpa, values->first_sample_s, 0.0);
    show(values, memory, over_kpa);
    return 1;
}

int unit_step(unit_values *values, unit_memory *memory, char fault[FAULT_ROOM])
{
    double over_kpa[PARTS], sum = 0.0;
    (void)fault;
    drive_period(&memory->drive, values->stage, over_kpa);
    for (int part = 0; part < PARTS; ++part) {
        const double part_s = PERIOD_S / PARTS;
        advance(values, memory, over_kpa[part], part_s, memory->since_begin_s + part * part_s);
        sum += over_kpa[part];
    }
    ++memory->sample;
    memory->since_begin_s = values->first_sample_s + memory->sample * PERIOD_S;
    show(values, memory, sum / PARTS);
    return 1;
}
