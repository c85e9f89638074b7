/* Registers of retarder-synth bench; a float has two, the higher half first. Generated: do not edit. */
#ifndef BENCH_WIRES_H
#define BENCH_WIRES_H

#define BENCH_SAMPLE 0 /* uint16_t: counts the samples; 0 follows 65535 */
#define BENCH_PASS_NUMBER 1 /* uint16_t: counts the cuts, from 1 */
#define BENCH_PRESENT 2 /* uint16_t: whether a cut is there; between cuts the position goes to its initial stage itself */
#define BENCH_CATEGORY 3 /* uint16_t: number of the weight category */
#define BENCH_AXLES 4 /* uint16_t: axles of the cut */
#define BENCH_STAGE_IN_FORCE 5 /* uint16_t: stage commanded last */
#define BENCH_COMMANDED_M_S 6 /* float: exit speed that is commanded */
#define BENCH_PATH_M 8 /* float: path of the first axle from the entrance of the first retarder, negative before it */
#define BENCH_MEASURED_M_S 10 /* float: speed that the radar shows; -1 for a missing reading */
#define BENCH_MEAN_OVERPRESSURE_KPA 12 /* float: mean since the last sample of the pressure above that at which the pads touch; for an estimator */
#define BENCH_PRESSURE_KPA 14 /* float: pressure that the gauge shows; for tables with slopes */
#define BENCH_AT_REST 16 /* uint16_t: whether the pressure of the commanded stage is reached; tables that decide at any time do not look at it */
#define BENCH_STAGE 100 /* uint16_t: stage to command */
#define BENCH_ANSWERS 101 /* uint16_t: the `sample` that it answers; written last */
#define BENCH_TOLD 17 /* registers from 0 on */

#endif
