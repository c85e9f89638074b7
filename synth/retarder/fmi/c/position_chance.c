/* The random numbers of a pass, those of retarder-synth for the same seed and number of pass.
 *
 * Words are of SFC64, seeded by the SeedSequence of numpy; normal numbers are those of Box and Muller, two a word, with
 * the float32 polynomials of the Cephes library (S. L. Moshier: logf, sinf, cosf). */
#include "position.h"

#include <math.h>
#include <string.h>

#define POOL 4
#define PATH_STREAM 0
#define NOISE_STREAM 1

typedef struct {
    uint64_t state[4];
} stream;

static uint32_t hashed(uint32_t value, uint32_t *constant, uint32_t factor)
{
    value ^= *constant;
    *constant *= factor;
    value *= *constant;
    return value ^ (value >> 16);
}

static uint32_t mixed(uint32_t one, uint32_t other)
{
    const uint32_t value = 0xca01f9ddu * one - 0x4973f715u * other;
    return value ^ (value >> 16);
}

/* The pool of numpy's SeedSequence(seed, spawn_key=keys). */
static void fill_pool(uint32_t pool[POOL], uint32_t seed, const uint32_t *keys, int count)
{
    uint32_t constant = 0x43b0d7e5u;
    for (int place = 0; place < POOL; ++place) {
        pool[place] = hashed(place == 0 ? seed : 0u, &constant, 0x931e8875u);
    }
    for (int from = 0; from < POOL; ++from) {
        for (int to = 0; to < POOL; ++to) {
            if (from != to) {
                pool[to] = mixed(pool[to], hashed(pool[from], &constant, 0x931e8875u));
            }
        }
    }
    for (int key = 0; key < count; ++key) {
        for (int to = 0; to < POOL; ++to) {
            pool[to] = mixed(pool[to], hashed(keys[key], &constant, 0x931e8875u));
        }
    }
}

static uint64_t next_word(stream *from)
{
    uint64_t *s = from->state;
    const uint64_t word = s[0] + s[1] + s[3]++;
    s[0] = s[1] ^ (s[1] >> 11);
    s[1] = s[2] + (s[2] << 3);
    s[2] = ((s[2] << 24) | (s[2] >> 40)) + word;
    return word;
}

/* The stream of a purpose in a block of passes. */
static stream stream_of(uint32_t seed, uint32_t block, uint32_t purpose)
{
    const uint32_t keys[] = {block, purpose};
    uint32_t pool[POOL], constant = 0x8b51f9ddu;
    stream made = {{0, 0, 0, 1}};
    fill_pool(pool, seed, keys, 2);
    for (int half = 0; half < 6; ++half) {
        made.state[half / 2] |= (uint64_t)hashed(pool[half % POOL], &constant, 0x58f38dedu) << (32 * (half % 2));
    }
    for (int turn = 0; turn < 12; ++turn) {
        next_word(&made);
    }
    return made;
}

/* Natural logarithm of (word + 1/2) / 2^32, at most 0. */
static float log_uniform(uint32_t word)
{
    const float uniform = (float)word + 0.5f;
    int32_t bits;
    memcpy(&bits, &uniform, sizeof bits);
    /* uniform = mantissa 2^exponent, mantissa from sqrt(1/2) to sqrt(2) */
    const int32_t exponent = (int32_t)(((uint32_t)(bits - 0x3f3504f3) + (64u << 23)) >> 23) - 64;
    bits -= (int32_t)((uint32_t)exponent << 23);
    float x, y = 7.0376836292e-2f;
    memcpy(&x, &bits, sizeof x);
    x -= 1.0f;
    y = y * x - 1.1514610310e-1f;
    y = y * x + 1.1676998740e-1f;
    y = y * x - 1.2420140846e-1f;
    y = y * x + 1.4249322787e-1f;
    y = y * x - 1.6668057665e-1f;
    y = y * x + 2.0000714765e-1f;
    y = y * x - 2.4999993993e-1f;
    y = y * x + 3.3333331174e-1f;
    const float square = x * x;
    const float found = x + (y * x * square - 0.5f * square) + (float)(exponent - 32) * 0.69314718055994530942f;
    return found < 0.0f ? found : 0.0f;
}

/* Two independent standard normal numbers from a word: its upper half is the radius, its lower half the angle. */
static void normal_pair(uint64_t word, float pair[2])
{
    const uint32_t angle = (uint32_t)word, quadrant = angle >> 30, within = angle << 2;
    float radius = sqrtf(-2.0f * log_uniform((uint32_t)(word >> 32)));
    int32_t turned;
    memcpy(&turned, &within, sizeof turned);
    const float turn = (float)turned * (float)(3.14159265358979323846 / 8589934592.0), square = turn * turn;
    float sine = -1.9515295891e-4f * square + 8.3321608736e-3f;
    sine = (sine * square - 1.6666654611e-1f) * square * turn + turn;
    float cosine = 2.443315711809948e-5f * square - 1.388731625493765e-3f;
    cosine = (cosine * square + 4.166664568298827e-2f) * square * square - 0.5f * square + 1.0f;
    radius = (quadrant & 2u) != 0 ? -radius : radius;
    pair[0] = radius * ((quadrant & 1u) != 0 ? -sine : cosine);
    pair[1] = radius * ((quadrant & 1u) != 0 ? cosine : sine);
}

/* The normal numbers of one pass: a block of passes shares a stream, two columns are drawn at a time for all. */
static void normal_numbers(const unit_values *values, uint32_t purpose, float *numbers, int count)
{
    const uint32_t pass = (uint32_t)values->pass_number;
    stream from = stream_of((uint32_t)values->seed, pass / BLOCK_PASSES, purpose);
    for (int column = 0; column < count; column += 2) {
        float pair[2] = {0.0f, 0.0f};
        for (uint32_t each = 0; each < BLOCK_PASSES; ++each) {
            const uint64_t word = next_word(&from);
            if (each == pass % BLOCK_PASSES) {
                normal_pair(word, pair);
            }
        }
        numbers[column] = pair[0];
        if (column + 1 < count) {
            numbers[column + 1] = pair[1];
        }
    }
}

/* Friction: the factor of the cut times 1 + eta; eta goes on from cell to cell with an exponential correlation. */
void vary_pads(const unit_values *values, position_path *path)
{
    float z[PATH_CELLS];
    double eta = 0.0, length_before = 0.0;
    const int first = path->approach_cells;
    normal_numbers(values, PATH_STREAM, z, path->cells - first);
    for (int cell = 0; cell < first; ++cell) {
        path->brake_m_s2_per_kpa[cell] = 0.0;
    }
    for (int cell = first; cell < path->cells; ++cell) {
        const double length = path->edge_m[cell + 1] - path->edge_m[cell];
        const double half = length / (2.0 * CORRELATION_LENGTH_M);
        const double std = values->path_std * sqrt(tanh(half) / half);
        const double memory = cell == first ? 0.0 : exp(-(0.5 * (length + length_before)) / CORRELATION_LENGTH_M);
        eta = memory * eta + sqrt(1.0 - memory * memory) * z[cell - first];
        path->brake_m_s2_per_kpa[cell] *= values->friction_factor * fmax(0.0, 1.0 + std * eta);
        length_before = length;
    }
}

static uint64_t split_mixed(uint64_t word)
{
    word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
    word = (word ^ (word >> 27)) * 0x94d049bb133111ebu;
    return word ^ (word >> 31);
}

/* Uniform number of a key, strictly between 0 and 1 (SplitMix64). */
static double keyed_uniform(uint64_t key, uint64_t column)
{
    const uint64_t golden = 0x9e3779b97f4a7c15u;
    const uint64_t state = split_mixed(LOST_FIRST_WORD + golden * (key + 1u));
    return ((double)(split_mixed(state + golden * (column + 1u)) >> 12) + 0.5) * 0x1p-52;
}

/* Readings are lost in bursts: a chain of two states that goes round twice, so that it ends as it began. */
static void lose_readings(const unit_values *values, position_readings *readings)
{
    const uint32_t pass = (uint32_t)values->pass_number;
    stream keys = stream_of((uint32_t)values->seed, pass / BLOCK_PASSES, LOSS_STREAM);
    uint64_t key = 0;
    for (uint32_t each = 0; each <= pass % BLOCK_PASSES; ++each) {
        key = next_word(&keys) >> 1;
    }
    const double stay = 1.0 - 1.0 / MISSED_READINGS;
    const double begin = (1.0 - stay) * values->missed_share / (1.0 - values->missed_share);
    int is_lost = keyed_uniform(key, 0) < values->missed_share;
    for (int sample = 0; sample < 2 * LOST_SAMPLES; ++sample) {
        is_lost = keyed_uniform(key, (uint64_t)(sample % LOST_SAMPLES) + 1u) < (is_lost ? stay : begin);
        readings->is_lost[sample % LOST_SAMPLES] = (unsigned char)is_lost;
    }
}

void draw_readings(const unit_values *values, position_readings *readings)
{
    memset(readings->is_lost, 0, sizeof readings->is_lost);
    normal_numbers(values, NOISE_STREAM, readings->noise_z, NOISE_SAMPLES);
    if (values->missed_share > 0.0) {
        lose_readings(values, readings);
    }
}

double reading_m_s(const unit_values *values, const position_readings *readings, int32_t sample, double speed_m_s)
{
    double shown = speed_m_s + values->noise_m_s * readings->noise_z[sample % NOISE_SAMPLES];
    if (readings->is_lost[sample % LOST_SAMPLES]) {
        return -1.0;
    }
    if (values->resolution_m_s > 0.0) {
        shown = rint(shown / values->resolution_m_s) * values->resolution_m_s;
    }
    return shown < 0.0 ? 0.0 : shown;
}
