/* An exported table book as a process that answers through its standard input and output; words in the machine's order.
 *
 *   decide          for {uint32 table, int32 stage, float s_m, float v_m_s, float pressure_kpa}: int32 stage to command;
 *                   all of a stream
 *   observe         for {uint32 table, uint32 start, float s_m, float v_m_s, float overpressure_kpa, 8 words}: the
 *                   estimated speed, the 16 words of the estimate and the alarms; all of a stream. start 0: the estimate goes on,
 *                   1: it begins, 2: it is the 8 words, whatever they are
 *   serve N         for {int32 what, float s_m, float v_m_s, float kpa}, at once: what OBSERVE, or BEGIN and observe:
 *                   float estimated speed of table N, kpa being the overpressure; else the int32 stage that it
 *                   commands, `what` being the stage and kpa the pressure
 *   select          for {uint32 layout, uint32 category, uint32 axles, float speed}: int32 status, the table (zeros if none)
 *   intact          for a table: int32, whether its checksum is right
 *   approach        nothing: for every table float approach in m, int32 entrance stage
 *   times           nothing: for every table int32, whether it decides at any time
 *   dump            all tables
 *   self-test       nothing; the exit code is the fault
 */
#include "retarder_self_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OBSERVE = -1, BEGIN = -2 }; /* no stages of a closed loop */

typedef struct reading {
    int32_t stage;
    float s_m;
    float v_m_s;
    float pressure_kpa;
} reading;

typedef struct request {
    int32_t what;
    float s_m;
    float v_m_s;
    float kpa;
} request;

typedef struct sample {
    uint32_t table;
    uint32_t start;
    float s_m;
    float v_m_s;
    float overpressure_kpa;
    retarder_estimate given;
} sample;

typedef char estimate_has_sixteen_words[(sizeof(retarder_estimate) == 64u) ? 1 : -1];

static void answer(int value)
{
    const int32_t word = value;
    if (fwrite(&word, sizeof word, 1, stdout) != 1) {
        exit(9);
    }
}

static int decision(const retarder_table *table, int stage, float s_m, float v_m_s, float pressure_kpa)
{
#ifdef RETARDER_GAUGE
    return retarder_decide_at_pressure(table, stage, s_m, v_m_s, pressure_kpa);
#else
    (void)pressure_kpa;
    return retarder_decide(table, stage, s_m, v_m_s);
#endif
}

static int decide(void)
{
    uint32_t number;
    reading now;
    while (fread(&number, sizeof number, 1, stdin) == 1 && fread(&now, sizeof now, 1, stdin) == 1) {
        answer(decision(number < retarder_table_count ? &retarder_tables[number] : 0, now.stage, now.s_m, now.v_m_s,
                        now.pressure_kpa));
    }
    return 0;
}

static void answer_float(float value)
{
    if (fwrite(&value, sizeof value, 1, stdout) != 1) {
        exit(9);
    }
}

static int observe(void)
{
    sample now;
    uint32_t alarms;
    retarder_estimate estimate;
    retarder_begin(&estimate);
    while (fread(&now, sizeof now, 1, stdin) == 1) {
        if (now.start == 1u) {
            retarder_begin(&estimate);
        } else if (now.start == 2u) {
            estimate = now.given;
        }
        const retarder_table *table = now.table < retarder_table_count ? &retarder_tables[now.table] : 0;
        answer_float(retarder_observe(table, &estimate, now.s_m, now.v_m_s, now.overpressure_kpa));
        alarms = retarder_alarms(table, &estimate);
        if (fwrite(&estimate, sizeof estimate, 1, stdout) != 1 || fwrite(&alarms, sizeof alarms, 1, stdout) != 1) {
            return 9;
        }
    }
    return 0;
}

static int serve(unsigned number)
{
    request now;
    retarder_estimate estimate;
    retarder_begin(&estimate);
    if (number >= retarder_table_count) {
        return 8;
    }
    setvbuf(stdin, 0, _IONBF, 0);
    setvbuf(stdout, 0, _IONBF, 0);
    while (fread(&now, sizeof now, 1, stdin) == 1) {
        const retarder_table *table = &retarder_tables[number];
        if (now.what == BEGIN) {
            retarder_begin(&estimate);
        }
        if (now.what == BEGIN || now.what == OBSERVE) {
            answer_float(retarder_observe(table, &estimate, now.s_m, now.v_m_s, now.kpa));
        } else {
            answer(decision(table, now.what, now.s_m, now.v_m_s, now.kpa));
        }
    }
    return 0;
}

static int choose(void)
{
    struct {
        uint32_t layout;
        uint32_t category;
        uint32_t axles;
        float speed_m_s;
    } command;
    while (fread(&command, sizeof command, 1, stdin) == 1) {
        retarder_table chosen;
        memset(&chosen, 0, sizeof chosen);
        answer(retarder_select(command.layout, command.category, command.axles, command.speed_m_s, &chosen));
        if (fwrite(&chosen, sizeof chosen, 1, stdout) != 1) {
            return 9;
        }
    }
    return 0;
}

static int intact(void)
{
    retarder_table table;
    while (fread(&table, sizeof table, 1, stdin) == 1) {
        answer(retarder_table_intact(&table));
    }
    return 0;
}

static int approach(void)
{
    uint32_t number;
    for (number = 0u; number < retarder_table_count; ++number) {
        answer_float(retarder_approach(&retarder_tables[number]));
        answer(retarder_entrance_stage(&retarder_tables[number]));
    }
    return 0;
}

static int times(void)
{
    uint32_t number;
    for (number = 0u; number < retarder_table_count; ++number) {
#ifdef RETARDER_AT_ANY_TIME
        answer(retarder_at_any_time(&retarder_tables[number]));
#else
        answer(0);
#endif
    }
    return 0;
}

int main(int count, char **arguments)
{
    const char *mode = count > 1 ? arguments[1] : "";
    if (strcmp(mode, "decide") == 0) {
        return decide();
    }
    if (strcmp(mode, "observe") == 0) {
        return observe();
    }
    if (strcmp(mode, "serve") == 0 && count > 2) {
        return serve((unsigned)strtoul(arguments[2], 0, 10));
    }
    if (strcmp(mode, "select") == 0) {
        return choose();
    }
    if (strcmp(mode, "intact") == 0) {
        return intact();
    }
    if (strcmp(mode, "approach") == 0) {
        return approach();
    }
    if (strcmp(mode, "times") == 0) {
        return times();
    }
    if (strcmp(mode, "dump") == 0) {
        return fwrite(retarder_tables, sizeof retarder_tables[0], retarder_table_count, stdout) == retarder_table_count
            ? 0 : 9;
    }
    if (strcmp(mode, "self-test") == 0) {
        uint32_t where = 0u;
        const int fault = retarder_self_test(&where);
        printf("fault %d at %lu\n", fault, (unsigned long)where);
        return fault;
    }
    fprintf(stderr, "unknown mode; see the head of this file\n");
    return 7;
}
