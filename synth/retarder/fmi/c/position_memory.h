/* What the position keeps between steps: path, drive, chance, and the cut on its way. */
#ifndef UNIT_MEMORY_H
#define UNIT_MEMORY_H

#include <stdint.h>

#include "position_data.h" /* generated: constants of the position */

/* Cells of the path, each with constant acceleration and constant slope of the pads. */
typedef struct {
    int cells;
    int approach_cells;             /* those before the entrance, where nothing brakes */
    double edge_m[CELL_ROOM + 1];
    double gravity_m_s2[CELL_ROOM]; /* by the grade, without resistance */
    double brake_m_s2_per_kpa[CELL_ROOM];
    double drag_m_s2;               /* by the rolling resistance */
} position_path;

/* The pneumatic drive: pressure, and the time until the valve opens that the commanded stage needs. */
typedef struct {
    double pressure_kpa;
    double wait_s;
    int stage;
} position_drive;

/* The random numbers of the radar in a pass; after the last they come again. */
typedef struct {
    float noise_z[NOISE_SAMPLES];
    unsigned char is_lost[LOST_SAMPLES];
} position_readings;

typedef struct {
    position_path path;
    position_drive drive;
    position_readings readings;
    int cell;
    double s_m;
    double v_m_s;
    double since_begin_s; /* at the last sample */
    int32_t sample;       /* number of the last */
} unit_memory;

#endif
