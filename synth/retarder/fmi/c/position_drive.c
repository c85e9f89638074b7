/* The pneumatic drive commanded at any moment: valve delays, filling and exhausting of first order, dead band. */
#include "position.h"

#include <math.h>

#define BAND_KPA (DEAD_BAND_KPA * (1.0 + 1e-12)) /* at the edge, whatever rounding brought it there */

/* Time until the valve opens that new_kpa needs, where old_kpa was commanded before. */
static double wait_after_command(const position_drive *drive, double old_kpa, double new_kpa)
{
    const double before = old_kpa - drive->pressure_kpa, missing = new_kpa - drive->pressure_kpa;
    if (fabs(missing) <= BAND_KPA) {
        return 0.0;
    }
    if (fabs(before) > BAND_KPA && (before > 0.0) == (missing > 0.0)) {
        return drive->wait_s;
    }
    if (missing > 0.0) {
        return BRAKE_DELAY_S + (drive->pressure_kpa <= TOUCH_KPA ? TOUCH_DELAY_S : 0.0);
    }
    return RELEASE_DELAY_S;
}

/* Time above the touch pressure while the overpressure flows from begin to end, towards asymptote. */
static double time_above(double begin, double end, double asymptote, double constant_s, double flowing_s)
{
    if (begin <= 0.0 && end <= 0.0) {
        return 0.0;
    }
    if (begin < 0.0) {
        return flowing_s - constant_s * log((asymptote - begin) / asymptote);
    }
    return end < 0.0 ? constant_s * log((asymptote - begin) / asymptote) : flowing_s;
}

/* Go on for a time with one stage commanded; returns the integral of the overpressure, kPa s. */
static double drive_on(position_drive *drive, double stage_kpa, double time_s)
{
    const double error = stage_kpa - drive->pressure_kpa, begin = drive->pressure_kpa - TOUCH_KPA;
    const double held = fmax(0.0, begin);
    if (fabs(error) <= BAND_KPA) {
        drive->wait_s = 0.0;
        return held * time_s;
    }
    if (drive->wait_s >= time_s) {
        drive->wait_s -= time_s;
        return held * time_s;
    }
    const double asymptote = error > 0.0 ? SUPPLY_KPA : EXHAUST_KPA;
    const double constant_s = error > 0.0 ? FILL_S : EXHAUST_S;
    const double until = error > 0.0 ? stage_kpa - DEAD_BAND_KPA : stage_kpa + DEAD_BAND_KPA;
    const double waited_s = drive->wait_s, rest_s = time_s - waited_s;
    double flowing_s = rest_s, end_kpa = asymptote + (drive->pressure_kpa - asymptote) * exp(-rest_s / constant_s);
    if (error > 0.0 ? end_kpa >= until : end_kpa <= until) {
        flowing_s = fmin(constant_s * log((asymptote - drive->pressure_kpa) / (asymptote - until)), rest_s);
        end_kpa = until;
    }
    const double end = end_kpa - TOUCH_KPA, above = asymptote - TOUCH_KPA;
    const double above_s = time_above(begin, end, above, constant_s, flowing_s);
    drive->pressure_kpa = end_kpa;
    drive->wait_s = 0.0;
    return held * waited_s + above * above_s + constant_s * (held - fmax(0.0, end))
        + fmax(0.0, end) * (rest_s - flowing_s);
}

/* The command of a sample is on the valves' wires after the computing delay. */
void drive_period(position_drive *drive, int stage, double over_kpa[PARTS])
{
    const double part_s = PERIOD_S / PARTS;
    const double old_kpa = STAGE_KPA[drive->stage], new_kpa = STAGE_KPA[stage];
    int is_commanded = 0;
    for (int part = 0; part < PARTS; ++part) {
        const double start_s = part * part_s;
        double total;
        if (is_commanded) {
            total = drive_on(drive, new_kpa, part_s);
        } else if (COMPUTING_DELAY_S >= start_s + part_s * (1.0 - 1e-9)) {
            total = drive_on(drive, old_kpa, part_s);
        } else {
            const double before_s = fmax(COMPUTING_DELAY_S - start_s, 0.0);
            total = drive_on(drive, old_kpa, before_s);
            drive->wait_s = wait_after_command(drive, old_kpa, new_kpa);
            total += drive_on(drive, new_kpa, part_s - before_s);
            is_commanded = 1;
        }
        over_kpa[part] = total / part_s;
    }
    drive->stage = stage;
}

int drive_rests(const position_drive *drive)
{
    return fabs(STAGE_KPA[drive->stage] - drive->pressure_kpa) <= BAND_KPA;
}
