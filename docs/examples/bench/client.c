/* The exported tables as a controller at the end of a Modbus cable: client HOST PORT [OFFSET_M_S]
 *
 * Build it in the folder of the exported C:
 *     cc -std=c99 -O2 -I. -o client client.c retarder_table.c
 * OFFSET_M_S, 0 unless given, is added to each measured speed: a controller that is wrong on purpose. */
#define _POSIX_C_SOURCE 200112L
#include "bench_wires.h"
#include "retarder_table.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

enum { READ = 4, WRITE = 16, HEAD = 7, ROOM = 260 };

static int cable;
static uint8_t told[2 * BENCH_TOLD];

static void stop(const char *why)
{
    fprintf(stderr, "client: %s\n", why);
    exit(1);
}

/* Send a request of `length` bytes behind its head, and take the answer; returns its function. */
static int asked(uint8_t *frame, int length)
{
    frame[0] = frame[1] = frame[2] = frame[3] = 0; /* transaction, protocol */
    frame[4] = 0;
    frame[5] = (uint8_t)(length + 1);
    frame[6] = 1; /* unit */
    if (send(cable, frame, (size_t)(HEAD + length), 0) != HEAD + length) {
        stop("the bench is gone");
    }
    if (recv(cable, frame, HEAD, MSG_WAITALL) != HEAD) {
        stop("the bench is gone");
    }
    const int rest = 256 * frame[4] + frame[5] - 1;
    if (rest < 2 || rest > ROOM - HEAD || recv(cable, frame + HEAD, (size_t)rest, MSG_WAITALL) != rest) {
        stop("the bench sent half an answer");
    }
    return frame[HEAD];
}

static void put(uint8_t *place, int word)
{
    place[0] = (uint8_t)(word >> 8);
    place[1] = (uint8_t)word;
}

/* All that the position tells, in one request: so it is all of one sample. */
static void read_told(void)
{
    uint8_t frame[ROOM] = {0};
    frame[HEAD] = READ;
    put(frame + HEAD + 1, 0);
    put(frame + HEAD + 3, BENCH_TOLD);
    if (asked(frame, 5) != READ) {
        stop("the bench refused to tell its registers");
    }
    memcpy(told, frame + HEAD + 2, sizeof told);
}

static int word_at(int address)
{
    return 256 * told[2 * address] + told[2 * address + 1];
}

static float float_at(int address)
{
    const uint32_t bits = (uint32_t)word_at(address) << 16 | (uint32_t)word_at(address + 1);
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

static void write_command(int stage, int sample)
{
    uint8_t frame[ROOM] = {0};
    frame[HEAD] = WRITE;
    put(frame + HEAD + 1, BENCH_STAGE);
    put(frame + HEAD + 3, 2);
    frame[HEAD + 5] = 4;
    put(frame + HEAD + 6, stage);
    put(frame + HEAD + 8, sample);
    if (asked(frame, 10) != WRITE) {
        fprintf(stderr, "client: stage %d was refused\n", stage);
    }
}

static void connect_to(const char *host, const char *port)
{
    struct addrinfo wanted = {0}, *found;
    const int one = 1;
    wanted.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(host, port, &wanted, &found) != 0) {
        stop("there is no such address");
    }
    cable = socket(found->ai_family, found->ai_socktype, found->ai_protocol);
    if (cable < 0 || connect(cable, found->ai_addr, found->ai_addrlen) != 0) {
        stop("nobody listens there");
    }
    setsockopt(cable, IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    freeaddrinfo(found);
}

static retarder_table table;
static retarder_estimate estimate;
static float offset_m_s;

/* One sample: the stage that the table commands. */
static int controlled(int stage)
{
    const float path_m = float_at(BENCH_PATH_M);
    const float shown_m_s = float_at(BENCH_MEASURED_M_S);
    const float measured_m_s = shown_m_s < 0.0f ? shown_m_s : shown_m_s + offset_m_s;
    const float speed_m_s
        = retarder_observe(&table, &estimate, path_m, measured_m_s, float_at(BENCH_MEAN_OVERPRESSURE_KPA));
    if (!word_at(BENCH_AT_REST) && !table.at_any_time) {
        return stage;
    }
    return retarder_decide(&table, stage, path_m, speed_m_s, float_at(BENCH_PRESSURE_KPA));
}

int main(int count, char **words)
{
    if (count < 3) {
        stop("give HOST PORT [OFFSET_M_S]");
    }
    offset_m_s = count > 3 ? strtof(words[3], NULL) : 0.0f;
    const struct timespec nap = {0, 2000000};
    int sample = -1, pass = -1;
    connect_to(words[1], words[2]);
    for (;;) {
        read_told();
        if (word_at(BENCH_SAMPLE) == sample) {
            nanosleep(&nap, NULL);
            continue;
        }
        sample = word_at(BENCH_SAMPLE);
        int stage = word_at(BENCH_STAGE_IN_FORCE);
        if (word_at(BENCH_PRESENT)) {
            if (word_at(BENCH_PASS_NUMBER) != pass) {
                pass = word_at(BENCH_PASS_NUMBER);
                retarder_begin(&estimate);
                if (retarder_select(word_at(BENCH_CATEGORY), word_at(BENCH_AXLES), float_at(BENCH_COMMANDED_M_S),
                        &table) < 0) {
                    stop("there is no table for this cut");
                }
            }
            stage = controlled(stage);
        }
        write_command(stage, sample);
    }
}
