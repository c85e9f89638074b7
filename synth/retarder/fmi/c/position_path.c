/* The path as a cut meets it: in each cell the acceleration by the grade and the deceleration by one kPa. */
#include "position.h"

#include <math.h>
#include <stdlib.h>

#define EDGE_ROOM (CELL_ROOM + BREAK_ROOM + 2)

static int compared(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Sort, and keep each place once. */
static int sorted(double *places, int count)
{
    int kept = 0;
    qsort(places, (size_t)count, sizeof *places, compared);
    for (int each = 0; each < count; ++each) {
        if (kept == 0 || places[each] != places[kept - 1]) {
            places[kept++] = places[each];
        }
    }
    return kept;
}

double path_exit_m(const unit_values *values)
{
    return ZONES_M[ZONES - 1][1] + values->axle_offsets_m[values->axles - 1];
}

static int with_break(double mark_m, const unit_values *values, double start_m, double *found, int count)
{
    for (int axle = 0; axle < values->axles; ++axle) {
        const double place = mark_m + values->axle_offsets_m[axle];
        if (place > start_m + 1e-9 && place < path_exit_m(values) - 1e-9) {
            found[count++] = rint(place * 1e9) / 1e9;
        }
    }
    return count;
}

/* Places from start_m to the exit, both included, where the braked axles or the grade under an axle change. */
static int breaks_of(const unit_values *values, double start_m, double *found)
{
    int count = 0;
    found[count++] = start_m;
    for (int zone = 0; zone < ZONES; ++zone) {
        count = with_break(ZONES_M[zone][0], values, start_m, found, count);
        count = with_break(ZONES_M[zone][1], values, start_m, found, count);
    }
    for (int grade = 0; grade < GRADES; ++grade) {
        count = with_break(GRADE_STARTS_M[grade], values, start_m, found, count);
    }
    found[count++] = path_exit_m(values);
    return sorted(found, count);
}

static double nearest_m(double place, const double *breaks, int count)
{
    double least = HUGE_VAL;
    for (int each = 0; each < count; ++each) {
        least = fmin(least, fabs(place - breaks[each]));
    }
    return least;
}

/* Edges of the cells from the entrance to the exit; a sliver beside a break is left out. */
static int braked_edges(const unit_values *values, double *edges)
{
    static const double sliver_m = 1e-3;
    double breaks[BREAK_ROOM];
    const double exit_m = path_exit_m(values);
    const int count = breaks_of(values, 0.0, breaks);
    const int is_long = count > PATH_CELLS / 2;
    const double wanted = ceil(exit_m / CELL_M);
    const int nodes = is_long ? PATH_CELLS : (int)fmin(wanted, PATH_CELLS - count);
    int edge = 0;
    for (int node = 0; node <= nodes; ++node) {
        const double place = node == nodes ? exit_m : node * (exit_m / nodes);
        if (is_long || nearest_m(place, breaks, count) > sliver_m) {
            edges[edge++] = place;
        }
    }
    for (int each = 0; each < count && !is_long; ++each) {
        edges[edge++] = breaks[each];
    }
    return sorted(edges, edge);
}

static double grade_permille(double place_m)
{
    int index = GRADES - 1;
    while (index > 0 && GRADE_STARTS_M[index] > place_m) {
        --index;
    }
    return GRADES_PERMILLE[index];
}

static double mean_grade_permille(const unit_values *values, double s_m)
{
    double sum = 0.0;
    for (int axle = 0; axle < values->axles; ++axle) {
        sum += grade_permille(s_m - values->axle_offsets_m[axle]);
    }
    return sum / values->axles;
}

static int braked_axles(const unit_values *values, double s_m)
{
    int count = 0;
    for (int axle = 0; axle < values->axles; ++axle) {
        const double place = s_m - values->axle_offsets_m[axle];
        for (int zone = 0; zone < ZONES; ++zone) {
            count += place >= ZONES_M[zone][0] && place < ZONES_M[zone][1];
        }
    }
    return count;
}

static double inertia_t(const unit_values *values)
{
    return values->mass_t + ROTATING_MASS_PER_AXLE_T * values->axles;
}

/* Deceleration by one kPa of overpressure with so many braked axles. */
static double brake_of(const unit_values *values, int axles)
{
    const int place = (axles < SLOPES ? axles : SLOPES) - 1;
    if (axles == 0) {
        return 0.0;
    }
    const double of_load = SLOPE_KN_PER_KPA_PER_T[place] * (values->mass_t / values->axles);
    return axles * (SLOPE_KN_PER_KPA[place] + of_load) / inertia_t(values);
}

/* Exact means over the cells between the edges. */
static void fill_cells(const unit_values *values, position_path *path, double reduced_gravity_m_s2)
{
    double fine[EDGE_ROOM];
    int count = breaks_of(values, fmin(0.0, path->edge_m[0]), fine), piece = 0;
    for (int edge = 0; edge <= path->cells; ++edge) {
        fine[count++] = path->edge_m[edge];
    }
    count = sorted(fine, count);
    for (int cell = 0; cell < path->cells; ++cell) {
        double gravity = 0.0, brake = 0.0;
        for (; piece + 1 < count && fine[piece] < path->edge_m[cell + 1]; ++piece) {
            const double length = fine[piece + 1] - fine[piece];
            const double middle = 0.5 * (fine[piece + 1] + fine[piece]);
            gravity += length * reduced_gravity_m_s2 * 1e-3 * mean_grade_permille(values, middle);
            brake += length * brake_of(values, braked_axles(values, middle));
        }
        const double length = path->edge_m[cell + 1] - path->edge_m[cell];
        path->gravity_m_s2[cell] = gravity / length;
        path->brake_m_s2_per_kpa[cell] = brake / length;
    }
}

void path_of_cut(const unit_values *values, position_path *path)
{
    const double reduced_gravity_m_s2 = GRAVITY_M_S2 * values->mass_t / inertia_t(values);
    double ahead[BREAK_ROOM];
    const int count = breaks_of(values, START_M, ahead);
    int before = 0;
    while (before < count && ahead[before] < 0.0) {
        path->edge_m[before] = ahead[before];
        ++before;
    }
    path->approach_cells = before;
    path->cells = before + braked_edges(values, path->edge_m + before) - 1;
    fill_cells(values, path, reduced_gravity_m_s2);
    path->drag_m_s2 = reduced_gravity_m_s2 * 1e-3 * values->resistance_n_per_kn;
}

/* Nothing brakes before the entrance, so the speed there tells the speed at the begin. */
double speed_at_begin(const position_path *path, double entry_speed_m_s)
{
    double gained = 0.0;
    for (int cell = 0; cell < path->approach_cells; ++cell) {
        gained += (path->gravity_m_s2[cell] - path->drag_m_s2) * (path->edge_m[cell + 1] - path->edge_m[cell]);
    }
    if (path->approach_cells == 0) {
        return entry_speed_m_s;
    }
    return sqrt(fmax(entry_speed_m_s * entry_speed_m_s - 2.0 * gained, SLOWEST_START_M_S * SLOWEST_START_M_S));
}
