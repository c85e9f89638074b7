/* Controller tables of a car retarder. Generated: do not edit, export again. See retarder_table.h. */
#include "retarder_table.h"

#include <float.h>

#if RETARDER_EXPORT != 0x8b6d5fa6u
#error "retarder_table.h is of another export: take all files from one"
#endif

#if FLT_RADIX != 2 || FLT_MANT_DIG != 24 || FLT_MAX_EXP != 128
#error "the rule needs float to be IEEE 754 binary32"
#endif

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ > 0)
#error "compile without -ffast-math and -ffinite-math-only: they remove the test for readings that are not finite"
#endif

#if !defined(__GNUC__) || defined(__clang__)
#pragma STDC FP_CONTRACT OFF /* GCC does not know it; `rounded` does the same for every compiler */
#endif

#define CRC_START 0xFFFFFFFFu

/* All members are words without gaps: the checksum runs over the words before the last. */
#if RETARDER_BREAKS > 0u
#define ESTIMATOR_WORDS (5u + 3u * RETARDER_BREAKS)
#else
#define ESTIMATOR_WORDS 0u
#endif
#define TABLE_WORDS (9u + RETARDER_STAGES + 2u * RETARDER_STAGES * RETARDER_POWERS + ESTIMATOR_WORDS)
typedef char retarder_table_has_no_gaps[(sizeof(retarder_table) == 4u * TABLE_WORDS) ? 1 : -1];

const unsigned retarder_table_count = 2u;

const retarder_table retarder_tables[] = {
    /* 0: loaded-to-3 */
    {
        1u, /* category */
        4u, /* axles */
        3u, /* stages */
        2u, /* coefficients of a line */
        {2u, 1u, 1u}, /* lines of stage 0, 1, ... */
        0x1.54p+6f, /* mass, 85 t */
        0x1.8p+1f, /* target speed, 3 m/s */
        0x0p+0f, 0x1.2b999ap+5f, /* path range, 0 to 37.45 m */
        {
            { /* stage 0 */
                {0x0p+0f, 0x0p+0f}, /* lower: none */
                {0x1.2p+2f, -0x1.99999ap-5f} /* upper: 4.5 -0.05 */
            },
            { /* stage 1 */
                {0x1p+2f, -0x1.70a3d8p-5f}, /* lower: 4 -0.045 */
                {0x0p+0f, 0x0p+0f} /* upper: none */
            },
            { /* stage 2 */
                {0x1.4p+3f, 0x0p+0f}, /* lower: 10 0 */
                {0x0p+0f, 0x0p+0f} /* upper: none */
            }
        },
        0x1fa974a2u /* crc32 */
    },
    /* 1: empty-to-3 */
    {
        2u, /* category */
        4u, /* axles */
        3u, /* stages */
        2u, /* coefficients of a line */
        {2u, 1u, 1u}, /* lines of stage 0, 1, ... */
        0x1.7p+4f, /* mass, 23 t */
        0x1.8p+1f, /* target speed, 3 m/s */
        0x0p+0f, 0x1.2b999ap+5f, /* path range, 0 to 37.45 m */
        {
            { /* stage 0 */
                {0x0p+0f, 0x0p+0f}, /* lower: none */
                {0x1.2p+2f, -0x1.99999ap-5f} /* upper: 4.5 -0.05 */
            },
            { /* stage 1 */
                {0x1p+2f, -0x1.70a3d8p-5f}, /* lower: 4 -0.045 */
                {0x0p+0f, 0x0p+0f} /* upper: none */
            },
            { /* stage 2 */
                {0x1.4p+3f, 0x0p+0f}, /* lower: 10 0 */
                {0x0p+0f, 0x0p+0f} /* upper: none */
            }
        },
        0xa4f726deu /* crc32 */
    }
};

/* Stores the value as float: one rounding, whatever the width of registers, and no fused multiply-add. */
static float rounded(float value)
{
    volatile float stored = value;
    return stored;
}

/* Speed of a line at path s, by Horner's rule from the highest power down. */
static float line_speed(const float *coefficients, uint32_t powers, float s_m)
{
    uint32_t power = powers - 1u;
    float speed = coefficients[power];
    while (power > 0u) {
        power -= 1u;
        speed = rounded(rounded(speed * s_m) + coefficients[power]);
    }
    return speed;
}

/* Whether the sizes are such that no index can leave the table, even if it was damaged. */
static int is_well_formed(const retarder_table *table)
{
#if RETARDER_BREAKS > 0u
    if (table->breaks > RETARDER_BREAKS || table->breaks == 1u) {
        return 0;
    }
#endif
    return table->stages <= RETARDER_STAGES && table->powers >= 1u && table->powers <= RETARDER_POWERS;
}

float retarder_target_speed(const retarder_table *table)
{
    return table == 0 ? 0.0f : table->target_m_s;
}

int retarder_decide(const retarder_table *table, int stage, float s_m, float v_m_s)
{
    float s = s_m;
    uint32_t lines;
    if (table == 0 || !is_well_formed(table) || stage < 0 || (uint32_t)stage >= table->stages) {
        return RETARDER_HOLD;
    }
    /* Written so that NaN fails it. */
    if (!(s_m >= -FLT_MAX && s_m <= FLT_MAX && v_m_s >= 0.0f && v_m_s <= FLT_MAX)) {
        return RETARDER_HOLD;
    }
    if (s < table->s_min_m) {
        s = table->s_min_m;
    }
    if (s > table->s_max_m) {
        s = table->s_max_m;
    }
    lines = table->lines[stage];
    if ((lines & 1u) != 0u && v_m_s < line_speed(table->coefficients[stage][0], table->powers, s)) {
        return RETARDER_LOWER;
    }
    if ((lines & 2u) != 0u && v_m_s > line_speed(table->coefficients[stage][1], table->powers, s)) {
        return RETARDER_RAISE;
    }
    return RETARDER_HOLD;
}

#if RETARDER_BREAKS > 0u

#define LEAST_SPEED_M_S 0x1.99999ap-3f
#define LEAST_STEP_M 0x1.0624dep-10f
#define LEAST_FACTOR 0x1.333334p-2f
#define LARGEST_FACTOR 0x1.e66666p+0f
#define LARGEST_SPEED_M_S 0x1.4p+5f
#define LARGEST_OVERPRESSURE_KPA 0x1.f4p+10f
#define LARGEST_STEP_M 0x1.4p+4f

/* A NaN as first argument stays: so does the reference. */
static float larger(float value, float least)
{
    return least > value ? least : value;
}

static float smaller(float value, float most)
{
    return most < value ? most : value;
}

/* One line of the table's work, at `part` of the way from break j to the next. */
static float work_at(const float *work, uint32_t j, float part)
{
    return rounded(work[j] + rounded(part * rounded(work[j + 1u] - work[j])));
}

/* What grade and brake have done from the entrance to path s. */
static void work_until(const retarder_table *table, float s_m, float *drive, float *brake)
{
    const float *breaks = table->work[0];
    const uint32_t last = table->breaks - 1u;
    const float place = smaller(larger(s_m, breaks[0]), breaks[last]);
    uint32_t j = 0u;
    float part;
    while (j + 1u < last && place > breaks[j + 1u]) {
        j += 1u;
    }
    part = rounded(rounded(place - breaks[j]) / rounded(breaks[j + 1u] - breaks[j]));
    *drive = work_at(table->work[1], j, part);
    *brake = work_at(table->work[2], j, part);
}

/* The first measured speed, taken as it is. */
static void begin_at(const retarder_table *table, retarder_estimate *estimate, float s_m, float v_m_s)
{
    estimate->begun = 1.0f;
    estimate->s_m = s_m;
    estimate->v_m_s = larger(v_m_s, LEAST_SPEED_M_S);
    estimate->factor = 1.0f;
    estimate->speed_variance = table->speed_variance;
    estimate->covariance = 0.0f;
    estimate->factor_variance = table->factor_variance;
}

/* Carry speed and covariance on to path s by the work done on the way. */
static void predict(const retarder_table *table, retarder_estimate *estimate, float s_m, float overpressure_kpa)
{
    const float v = estimate->v_m_s;
    const float p11 = estimate->speed_variance;
    const float p12 = estimate->covariance;
    const float p22 = estimate->factor_variance;
    float drive, brake, drive_before, brake_before;
    float work_at_one, gained, mean, predicted, slope, effect, path_variance, speed_part, cross_part, factor_part;
    work_until(table, s_m, &drive, &brake);
    work_until(table, estimate->s_m, &drive_before, &brake_before);
    work_at_one = rounded(overpressure_kpa * rounded(brake - brake_before));
    gained = rounded(rounded(drive - drive_before) - rounded(estimate->factor * work_at_one));
    mean = larger(rounded(rounded(rounded(v + v) + rounded(gained / v)) / 2.0f), LEAST_SPEED_M_S);
    predicted = larger(rounded(v + rounded(gained / mean)), LEAST_SPEED_M_S);
    slope = rounded(v / predicted);
    effect = rounded(work_at_one / mean);
    path_variance = rounded(table->path_variance / larger(rounded(s_m - estimate->s_m), LEAST_STEP_M));
    speed_part = rounded(rounded(slope * slope) * p11);
    cross_part = rounded(rounded(rounded(2.0f * slope) * effect) * p12);
    factor_part = rounded(rounded(effect * effect) * rounded(p22 + path_variance));
    estimate->s_m = s_m;
    estimate->v_m_s = predicted;
    estimate->speed_variance = rounded(rounded(speed_part - cross_part) + factor_part);
    estimate->covariance = rounded(rounded(slope * p12) - rounded(effect * p22));
}

/* Weigh a measured speed by the covariance. */
static void correct(const retarder_table *table, retarder_estimate *estimate, float v_m_s)
{
    const float p11 = estimate->speed_variance;
    const float p12 = estimate->covariance;
    const float total = rounded(p11 + table->speed_variance);
    const float gain = rounded(p11 / total);
    const float factor_gain = rounded(p12 / total);
    const float surprise = rounded(v_m_s - estimate->v_m_s);
    const float factor = rounded(estimate->factor + rounded(factor_gain * surprise));
    const float factor_variance = rounded(estimate->factor_variance - rounded(factor_gain * p12));
    estimate->v_m_s = larger(rounded(estimate->v_m_s + rounded(gain * surprise)), LEAST_SPEED_M_S);
    estimate->factor = smaller(larger(factor, LEAST_FACTOR), LARGEST_FACTOR);
    estimate->factor_variance = larger(factor_variance, 0.0f);
    estimate->covariance = rounded(p12 - rounded(gain * p12));
    estimate->speed_variance = rounded(p11 - rounded(gain * p11));
}

/* retarder_observe for a sound table with an estimator. All comparisons are written so that NaN fails them. */
static float observe(const retarder_table *table, retarder_estimate *estimate, float s_m, float v_m_s,
                     float overpressure_kpa)
{
    const int is_begun = !(estimate->begun >= 0.0f && estimate->begun <= 0.0f);
    const int is_credible = v_m_s >= 0.0f && v_m_s <= LARGEST_SPEED_M_S;
    const int is_pressed = overpressure_kpa >= 0.0f && overpressure_kpa <= LARGEST_OVERPRESSURE_KPA;
    const float before = is_begun ? estimate->s_m : table->work[0][0];
    const float farthest = is_begun ? rounded(before + LARGEST_STEP_M) : table->work[0][table->breaks - 1u];
    const float s = s_m >= before && s_m <= farthest ? s_m : before;
    if (is_begun) {
        predict(table, estimate, s, is_pressed ? overpressure_kpa : 0.0f);
        if (is_credible) {
            correct(table, estimate, v_m_s);
        }
    } else if (is_credible) {
        begin_at(table, estimate, s, v_m_s);
    } else {
        return -1.0f;
    }
    return estimate->v_m_s;
}

float retarder_touch_pressure(const retarder_table *table)
{
    return table == 0 ? 0.0f : table->touch_kpa;
}

float retarder_observe(const retarder_table *table, retarder_estimate *estimate, float s_m, float v_m_s,
                       float overpressure_kpa)
{
    if (table == 0 || estimate == 0 || !is_well_formed(table)) {
        return -1.0f;
    }
    return table->breaks == 0u ? v_m_s : observe(table, estimate, s_m, v_m_s, overpressure_kpa);
}

#else

float retarder_touch_pressure(const retarder_table *table)
{
    (void)table;
    return 0.0f;
}

float retarder_observe(const retarder_table *table, retarder_estimate *estimate, float s_m, float v_m_s,
                       float overpressure_kpa)
{
    (void)s_m;
    (void)overpressure_kpa;
    return table == 0 || estimate == 0 || !is_well_formed(table) ? -1.0f : v_m_s;
}

#endif

void retarder_begin(retarder_estimate *estimate)
{
    static const retarder_estimate unknown = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
    if (estimate != 0) {
        *estimate = unknown;
    }
}

static uint32_t crc_of_byte(uint32_t crc, unsigned char byte)
{
    uint32_t value = crc ^ byte;
    int bit;
    for (bit = 0; bit < 8; ++bit) {
        value = (value >> 1) ^ ((value & 1u) != 0u ? 0xEDB88320u : 0u);
    }
    return value;
}

uint32_t retarder_crc32(const unsigned char *bytes, uint32_t count)
{
    uint32_t crc = CRC_START;
    uint32_t index;
    for (index = 0u; index < count; ++index) {
        crc = crc_of_byte(crc, bytes[index]);
    }
    return crc ^ CRC_START;
}

/* The checksum that the table ought to have, the same on processors of either byte order. */
static uint32_t table_crc32(const retarder_table *table)
{
    const uint32_t probe = 1u;
    const uint32_t turn = *(const unsigned char *)&probe == 1u ? 0u : 3u;
    const unsigned char *bytes = (const unsigned char *)table;
    uint32_t crc = CRC_START;
    uint32_t index;
    for (index = 0u; index < 4u * (TABLE_WORDS - 1u); ++index) {
        crc = crc_of_byte(crc, bytes[index ^ turn]);
    }
    return crc ^ CRC_START;
}

int retarder_table_intact(const retarder_table *table)
{
    return table != 0 && is_well_formed(table) && table_crc32(table) == table->crc32;
}

#if RETARDER_BREAKS > 0u
static int differ(float one, float other)
{
    return one < other || one > other;
}
#endif

/* Whether both tables estimate the same from the same readings, or neither does. */
static int is_same_estimator(const retarder_table *slower, const retarder_table *faster)
{
#if RETARDER_BREAKS > 0u
    uint32_t row, j;
    if (slower->breaks != faster->breaks || differ(slower->speed_variance, faster->speed_variance)
        || differ(slower->factor_variance, faster->factor_variance)
        || differ(slower->path_variance, faster->path_variance)) {
        return 0;
    }
    for (row = 0u; row < 3u; ++row) {
        for (j = 0u; j < RETARDER_BREAKS; ++j) {
            if (differ(slower->work[row][j], faster->work[row][j])) {
                return 0;
            }
        }
    }
#else
    (void)slower;
    (void)faster;
#endif
    return 1;
}

/* Whether lines between the two have a meaning: same stages, degree, lines, path range and estimator. */
static int is_interpolable(const retarder_table *slower, const retarder_table *faster)
{
    uint32_t stage;
    if (slower->stages != faster->stages || slower->powers != faster->powers
        || slower->s_min_m < faster->s_min_m || slower->s_min_m > faster->s_min_m
        || slower->s_max_m < faster->s_max_m || slower->s_max_m > faster->s_max_m) {
        return 0;
    }
    for (stage = 0u; stage < RETARDER_STAGES; ++stage) {
        if (slower->lines[stage] != faster->lines[stage]) {
            return 0;
        }
    }
    return is_same_estimator(slower, faster);
}

/* Of the tables of this class: the fastest not above the speed, and the slowest above it; null where there is none. */
static int find_neighbours(uint32_t category, uint32_t axles, float speed_m_s, const retarder_table **slower,
                           const retarder_table **faster)
{
    float heaviest_t = -1.0f;
    uint32_t number;
    *slower = 0;
    *faster = 0;
    for (number = 0u; number < retarder_table_count; ++number) {
        const retarder_table *table = &retarder_tables[number];
        if (table->category != category || table->axles != axles || table->mass_t < heaviest_t) {
            continue;
        }
        if (table->mass_t > heaviest_t) {
            heaviest_t = table->mass_t;
            *slower = 0;
            *faster = 0;
        }
        /* A later table of equal speed does not replace an earlier one. */
        if (table->target_m_s <= speed_m_s) {
            if (*slower == 0 || table->target_m_s > (*slower)->target_m_s) {
                *slower = table;
            }
        } else if (*faster == 0 || table->target_m_s < (*faster)->target_m_s) {
            *faster = table;
        }
    }
    return heaviest_t >= 0.0f;
}

/* `chosen` becomes the table for speed_m_s between the two; every operation is rounded to float. */
static void interpolate(const retarder_table *slower, const retarder_table *faster, float speed_m_s,
                        retarder_table *chosen)
{
    const float step = rounded(faster->target_m_s - slower->target_m_s);
    const float weight = rounded(rounded(speed_m_s - slower->target_m_s) / step);
    uint32_t stage, line, power;
    *chosen = *slower;
    chosen->target_m_s = speed_m_s;
    for (stage = 0u; stage < RETARDER_STAGES; ++stage) {
        for (line = 0u; line < 2u; ++line) {
            for (power = 0u; power < RETARDER_POWERS; ++power) {
                const float low = slower->coefficients[stage][line][power];
                const float rise = rounded(faster->coefficients[stage][line][power] - low);
                chosen->coefficients[stage][line][power] = rounded(low + rounded(weight * rise));
            }
        }
    }
    chosen->crc32 = table_crc32(chosen);
}

int retarder_select(uint32_t category, uint32_t axles, float speed_m_s, retarder_table *chosen)
{
    const retarder_table *slower;
    const retarder_table *faster;
    if (chosen == 0 || !find_neighbours(category, axles, speed_m_s, &slower, &faster)) {
        return RETARDER_NO_CLASS;
    }
    if (!(speed_m_s > 0.0f && speed_m_s <= FLT_MAX) || slower == 0) {
        return RETARDER_NO_TARGET;
    }
    if (slower->target_m_s >= speed_m_s) {
        *chosen = *slower;
        return RETARDER_TUNED;
    }
    if (faster == 0 || !is_interpolable(slower, faster)) {
        *chosen = *slower;
        return RETARDER_SLOWER;
    }
    interpolate(slower, faster, speed_m_s, chosen);
    return RETARDER_BETWEEN;
}
