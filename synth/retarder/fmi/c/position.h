/* The parts of the position: path.c, drive.c, chance.c; position.c puts them together. */
#ifndef POSITION_H
#define POSITION_H

#include "unit.h"

/* path.c: cells of the path as a cut meets them (plant_models/motion.py). */
void path_of_cut(const unit_values *values, position_path *path);
double path_exit_m(const unit_values *values);
double speed_at_begin(const position_path *path, double entry_speed_m_s);

/* drive.c: from one sample to the next (plant_models/valve_drive.py): mean overpressure of each part of the period. */
void drive_period(position_drive *drive, int stage, double over_kpa[PARTS]);
int drive_rests(const position_drive *drive);

/* chance.c: the random numbers of a pass; eta of the pads is worked into the slopes of the path. */
void vary_pads(const unit_values *values, position_path *path);
void draw_readings(const unit_values *values, position_readings *readings);
double reading_m_s(const unit_values *values, const position_readings *readings, int32_t sample, double speed_m_s);

#endif
