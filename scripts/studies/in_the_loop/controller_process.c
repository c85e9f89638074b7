/* An exported table book as a process that answers through its standard input and output; words in the machine's order.
 *
 *   decide          for {int32 table, int32 stage, float s_m, float v_m_s, float pressure_kpa}: int32 stage to command;
 *                   all of a stream
 *   observe         for {int32 table, int32 start, float s_m, float v_m_s, float overpressure_kpa, 16 words}: the
 *                   estimated speed, the 16 words of the estimate and the alarms; all of a stream. start 0: the estimate
 *                   goes on, 1: it begins, 2: it is the 16 words, whatever they are
 *   serve N         for {int32 what, float s_m, float v_m_s, float kpa}, at once: what OBSERVE, or BEGIN and observe:
 *                   float estimated speed of table N, kpa being the overpressure; else the int32 stage that it
 *                   commands, `what` being the stage and kpa the pressure
 *   select          for {int32 category, int32 axles, float speed}: int32 status, the table (zeros if none)
 *   intact          for a table: int32, whether its checksum is right
 *   dump            all tables
 *   self-test       nothing; the exit code is the fault
 */
#include "retarder_self_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { OBSERVE = -1, BEGIN = -2 }; /* no stages of a closed loop */

typedef struct reading {
    int32_t table;
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
    int32_t table;
    int32_t start;
    float s_m;
    float v_m_s;
    float overpressure_kpa;
    retarder_estimate given;
} sample;

typedef char estimate_has_sixteen_words[(sizeof(retarder_estimate) == 64u) ? 1 : -1];

static void answer(int32_t word)
{
    if (fwrite(&word, sizeof word, 1, stdout) != 1) {
        exit(9);
    }
}

static const retarder_table *numbered(int32_t number)
{
    return number >= 0 && number < retarder_table_count ? &retarder_tables[number] : 0;
}

static int decide(void)
{
    reading now;
    while (fread(&now, sizeof now, 1, stdin) == 1) {
        answer(retarder_decide(numbered(now.table), now.stage, now.s_m, now.v_m_s, now.pressure_kpa));
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
    retarder_estimate estimate;
    retarder_begin(&estimate);
    while (fread(&now, sizeof now, 1, stdin) == 1) {
        if (now.start == 1) {
            retarder_begin(&estimate);
        } else if (now.start == 2) {
            estimate = now.given;
        }
        const retarder_table *table = numbered(now.table);
        answer_float(retarder_observe(table, &estimate, now.s_m, now.v_m_s, now.overpressure_kpa));
        if (fwrite(&estimate, sizeof estimate, 1, stdout) != 1) {
            return 9;
        }
        answer(retarder_alarms(table, &estimate));
    }
    return 0;
}

static int serve(int32_t number)
{
    request now;
    retarder_estimate estimate;
    retarder_begin(&estimate);
    const retarder_table *table = numbered(number);
    if (table == 0) {
        return 8;
    }
    setvbuf(stdin, 0, _IONBF, 0);
    setvbuf(stdout, 0, _IONBF, 0);
    while (fread(&now, sizeof now, 1, stdin) == 1) {
        if (now.what == BEGIN) {
            retarder_begin(&estimate);
        }
        if (now.what == BEGIN || now.what == OBSERVE) {
            answer_float(retarder_observe(table, &estimate, now.s_m, now.v_m_s, now.kpa));
        } else {
            answer(retarder_decide(table, now.what, now.s_m, now.v_m_s, now.kpa));
        }
    }
    return 0;
}

static int choose(void)
{
    struct {
        int32_t category;
        int32_t axles;
        float speed_m_s;
    } command;
    while (fread(&command, sizeof command, 1, stdin) == 1) {
        retarder_table chosen;
        memset(&chosen, 0, sizeof chosen);
        answer(retarder_select(command.category, command.axles, command.speed_m_s, &chosen));
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
        return serve((int32_t)strtol(arguments[2], 0, 10));
    }
    if (strcmp(mode, "select") == 0) {
        return choose();
    }
    if (strcmp(mode, "intact") == 0) {
        return intact();
    }
    if (strcmp(mode, "dump") == 0) {
        const size_t count_of_tables = (size_t)retarder_table_count;
        return fwrite(retarder_tables, sizeof retarder_tables[0], count_of_tables, stdout) == count_of_tables ? 0 : 9;
    }
    if (strcmp(mode, "self-test") == 0) {
        uint32_t where = 0u;
        const int32_t fault = retarder_self_test(&where);
        printf("fault %d at %lu\n", (int)fault, (unsigned long)where);
        return (int)fault;
    }
    fprintf(stderr, "unknown mode; see the head of this file\n");
    return 7;
}
