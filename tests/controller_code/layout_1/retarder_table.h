/* Controller tables of a car retarder, and the rule by which they decide. Generated: do not edit, export again.
 * This text may be used, changed and passed on without any condition.
 *
 * retarder   <U+041A><U+041D><U+041F>-5 <U+002F><U+002A> bunch <U+002A><U+002F> <U+003F><U+003F><U+002F>
 * tables     2
 * made by    retarder-synth 0.1.0, 2026-11-21T08:00:00Z
 *            configuration 0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef
 *
 * C99, freestanding: no heap, no library call, no state. Compile with -std=c99; never with -ffast-math.
 * Call retarder_self_test() (retarder_self_test.h) once at start, and retarder_table_intact() as often as you doubt.
 */
#ifndef RETARDER_TABLE_H
#define RETARDER_TABLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the rule asks for. */
#define RETARDER_LOWER (-1)
#define RETARDER_HOLD (0)
#define RETARDER_RAISE (1)

/* How a choice ended; below 0 no table was chosen. */
#define RETARDER_TUNED (0)       /* a table for this very speed */
#define RETARDER_BETWEEN (1)     /* lines between those of two tables */
#define RETARDER_SLOWER (2)      /* the nearest table that aims at less than was commanded */
#define RETARDER_NO_CLASS (-1)   /* no table for this category and number of axles */
#define RETARDER_NO_TARGET (-2)  /* no number, or below the lowest target: every table would let the cut out too fast */

/* Weight categories. */
#define RETARDER_CATEGORY_T 1u /* <U+0422> */
#define RETARDER_CATEGORY_L 2u /* <U+041B> */

#define RETARDER_EXPORT 0x8b6d5fa6u /* of all files of one export, so that they cannot be mixed */

#define RETARDER_STAGES 3u /* most stages of a table, stage 0 (released) included */
#define RETARDER_POWERS 2u /* most coefficients of a line */
#define RETARDER_BREAKS 0u /* most breaks of an estimator; 0: no table has one */

/* One table. Every member is 32 bits wide. Treat it as closed; it is laid open because an array of it is declared. */
typedef struct retarder_table {
    uint32_t category;
    uint32_t axles;
    uint32_t stages;                 /* stages 0 ... stages - 1 */
    uint32_t powers;                 /* coefficients of a line: its degree + 1 */
    uint32_t lines[RETARDER_STAGES]; /* lines of a stage: 1 lower, 2 upper, 3 both, 0 none */
    float mass_t;
    float target_m_s;
    float s_min_m; /* the path is clamped into this range */
    float s_max_m;
    float coefficients[RETARDER_STAGES][2][RETARDER_POWERS]; /* of lower and upper, ascending powers of s in m */
#if RETARDER_BREAKS > 0u
    uint32_t breaks;      /* of the estimator; 0: the table has none, its lines are for the measured speed */
    float speed_variance; /* of a measured speed, m2/s2 */
    float factor_variance; /* of the friction factor of cuts */
    float path_variance;  /* of the friction along the path, times its correlation length, m */
    float touch_kpa;      /* pressure at which the beams touch the wheels */
    float work[3][RETARDER_BREAKS]; /* path in m; work of grade, m2/s2; work of the brake for each kPa, m2/s2 */
#endif
    uint32_t crc32; /* CRC-32 of all words before it, each taken from its lowest byte to its highest */
} retarder_table;

/* What is known of the cut in the retarder: seven words, one such structure for each cut. Treat it as closed. */
typedef struct retarder_estimate {
    float begun; /* 0: no speed was measured yet */
    float s_m;
    float v_m_s;
    float factor; /* of the friction of this cut */
    float speed_variance;
    float covariance;
    float factor_variance;
} retarder_estimate;

extern const unsigned retarder_table_count;
extern const retarder_table retarder_tables[];

/* The exit speed that the table aims at, m/s; 0 without a table. */
float retarder_target_speed(const retarder_table *table);

/* The pressure P0 in kPa above which brake cylinders brake, for retarder_observe; 0 without estimator. */
float retarder_touch_pressure(const retarder_table *table);

/* Forget the last cut: to be called once for each cut before its first sample. */
void retarder_begin(retarder_estimate *estimate);

/* The speed to ask retarder_decide with, m/s: the estimated one, or v_m_s as it is if the table has no estimator.
 *
 * To be called once at every sample, also while a change of stage is under way, with the path of the first axle, the
 * measured speed and the mean of max(0, P - P0) since the sample before. What cannot be true is not believed: a speed
 * above 40 m/s, negative or not finite (a missing reading: hand over -1) corrects nothing, such an overpressure (above
 * 2000 kPa) counts as 0, a path that goes back, or on by more than 20 m, as no movement.
 *
 * -1, at which retarder_decide holds, as long as no speed was measured, and without table or estimate. */
float retarder_observe(const retarder_table *table, retarder_estimate *estimate, float s_m, float v_m_s,
                       float overpressure_kpa);

/* RETARDER_LOWER, RETARDER_HOLD or RETARDER_RAISE: what to do at `stage` with the first axle at s_m and speed v_m_s,
 * which is that of retarder_observe.
 *
 * To be asked at each sample at which no change of stage is under way. RETARDER_HOLD is the answer to whatever cannot
 * be true: no table, no such stage, a path or speed that is not finite, a negative speed. */
int retarder_decide(const retarder_table *table, int stage, float s_m, float v_m_s);

/* Fill `chosen` with the table for a cut of this category and number of axles that shall leave with speed_m_s.
 *
 * Returns one of the five values above. Where it is below 0, or `chosen` is null, `chosen` is left as it was: then
 * whoever commands must decide, for no table here is known to be safe. */
int retarder_select(uint32_t category, uint32_t axles, float speed_m_s, retarder_table *chosen);

/* 1 if the checksum of the table is right (in ROM, or the copy that retarder_select has made), else 0. */
int retarder_table_intact(const retarder_table *table);

/* CRC-32 (ISO 3309; zlib, Ethernet) of `count` bytes; the bytes "123456789" give 0xCBF43926. */
uint32_t retarder_crc32(const unsigned char *bytes, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
