#include "gp_state.h"

#include <string.h>

#include "gp_crc.h"
#include "gp_linalg.h"
#include "gp_schedule.h"

enum { HEADER = 72, VERSION = 2, SINGLE = 16, SCALARS = SINGLE + 2 * GP_STEP_SIZES };

static int refuse(GpInstance *p, const char *why) {
    gp_text_clear(&p->message);
    gp_text_add(&p->message, "The state cannot be used: ");
    gp_text_add(&p->message, why);
    return -1;
}

/* The arrays, one after another: NULL behind the last. */
static double *visit(const GpInstance *p, int i, size_t *count) {
    const GpModel *m = &p->model;
    switch (i) {
    case 0: *count = m->blocks; return p->K;
    case 1: *count = m->blocks; return p->C;
    case 2: *count = m->blocks; return p->valid_K;
    case 3: *count = m->blocks; return p->valid_C;
    case 4: *count = m->groups; return p->zeta;
    case 5: *count = m->groups; return p->valid_zeta;
    case 6: *count = m->loads; return p->input;
    case 7: *count = m->loads; return p->slope;
    case 8: *count = m->tones; return p->source.amplitude;
    case 9: *count = m->tones; return p->source.phase;
    case 10: *count = m->order; return p->now;
    default: *count = 0; return NULL;
    }
}

static size_t doubles(const GpInstance *p) {
    size_t total = GP_STATE_EXTRA + SCALARS + p->model.joints, count;
    for (int i = 0; visit(p, i, &count); i++) total += count;
    return total;
}

size_t gp_state_size(const GpInstance *p) { return HEADER + 8 * doubles(p); }

static void put(unsigned char **at, double value) {
    memcpy(*at, &value, sizeof value);
    *at += sizeof value;
}

static double take(const unsigned char **at) {
    double value;
    memcpy(&value, *at, sizeof value);
    *at += sizeof value;
    return value;
}

void gp_state_write(GpInstance *p, const double *extra, unsigned char *bytes) {
    const uint64_t size = gp_state_size(p);
    const uint32_t words[2] = {VERSION, 0x01020304u}, zero = 0;
    const double scalars[SINGLE] = {p->frequency,          p->frequency_slope, p->source.teeth, p->source.speed,
                                    p->source.speed_slope, p->source.turns,    p->source.part,  p->time,
                                    p->modal,              !p->system_ready,   p->begun,        (double)p->steps,
                                    p->source.rest,        p->torque,          p->torque_slope, p->used_torque};
    unsigned char *at = bytes + HEADER;
    uint32_t crc;
    size_t count;
    for (size_t i = 0; i < GP_STATE_EXTRA; i++) put(&at, extra[i]);
    for (size_t i = 0; i < SINGLE; i++) put(&at, scalars[i]);
    for (size_t i = 0; i < GP_STEP_SIZES; i++) {
        put(&at, p->discrete[i].h);
        put(&at, (double)p->discrete[i].used);
    }
    for (size_t j = 0; j < p->model.joints; j++) put(&at, p->changed[j]);
    for (int i = 0; visit(p, i, &count); i++)
        for (size_t k = 0; k < count; k++) put(&at, visit(p, i, &count)[k]);
    memcpy(bytes, "GPSTATE", 8);
    memcpy(bytes + 8, words, 8);
    memcpy(bytes + 16, &size, 8);
    memcpy(bytes + 28, &zero, 4);
    memcpy(bytes + 32, p->model.guid, 40);
    crc = gp_crc32(bytes + 32, (size_t)size - 32);
    memcpy(bytes + 24, &crc, 4);
}

static int check_header(GpInstance *p, const unsigned char *bytes, size_t size) {
    uint32_t word[4];
    uint64_t stated;
    if (!bytes || size < HEADER) return refuse(p, "it is missing or too short.");
    memcpy(word, bytes + 8, 8);
    memcpy(&stated, bytes + 16, 8);
    memcpy(word + 2, bytes + 24, 8);
    if (memcmp(bytes, "GPSTATE", 8) != 0) return refuse(p, "it is not the state of a Gearpath model.");
    if (word[0] != VERSION || word[1] != 0x01020304u) return refuse(p, "another version of the runtime wrote it.");
    if (memcmp(bytes + 32, p->model.guid, 40) != 0) return refuse(p, "it belongs to another model.");
    if (stated != size || size != gp_state_size(p)) return refuse(p, "its size is wrong.");
    if (word[3] || word[2] != gp_crc32(bytes + 32, size - 32)) return refuse(p, "its checksum is wrong.");
    for (const unsigned char *at = bytes + HEADER; at < bytes + size;)
        if (!gp_finite(take(&at))) return refuse(p, "a number in it is not finite.");
    return 0;
}

static int is_flag(double value) { return value == 0 || value == 1; }
static int is_count(double value) { return value >= 0 && value < 9e15 && value == (double)(long long)value; }

static int scalars_are_good(const GpInstance *p, const double *s) {
    const GpModel *m = &p->model;
    for (size_t i = 0; i < GP_STEP_SIZES; i++)
        if (s[SINGLE + 2 * i] < 0 || !is_count(s[SINGLE + 1 + 2 * i])) return 0;
    if (!is_flag(s[8]) || !is_flag(s[9]) || !is_flag(s[10]) || !is_count(s[11])) return 0;
    if (m->source_load != GP_NONE && !(s[2] >= 1 && s[2] <= 1e6 && is_count(s[2]) && s[6] >= 0 && s[6] <= 1)) return 0;
    return s[8] == 0 || m->pairs;
}

/* Whether the packed matrices are symmetric, and (where they are in use) positive semidefinite, as those that follow
   the torque are. */
static int matrices_are_good(const GpInstance *p, const double *packed, int in_use, uint32_t follow) {
    unsigned char used[6];
    for (size_t j = 0; j < p->model.joints; j++) {
        const size_t d = p->model.joint[j].size;
        const double *A = packed + p->model.joint[j].block;
        for (size_t k = 0; k < d * d; k++)
            if (A[k] != A[k % d * d + k / d]) return 0;
        if (in_use && !(p->model.joint[j].follows & follow) && !gp_semidefinite(A, d, p->work, used)) return 0;
    }
    return 1;
}

static int ratios_are_good(const double *zeta, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (!(zeta[i] >= 0 && zeta[i] < 1)) return 0;
    return 1;
}

int gp_state_check(GpInstance *p, const unsigned char *bytes, size_t size) {
    double value[SCALARS];
    const double *blocks, *zeta;
    const GpModel *m = &p->model;
    const unsigned char *at = bytes + HEADER + GP_STATE_EXTRA * sizeof *value;
    int good = 1;
    if (check_header(p, bytes, size)) return -1;
    for (size_t i = 0; i < SCALARS; i++) value[i] = take(&at);
    for (size_t j = 0; j < m->joints; j++) good = good && is_flag(take(&at));
    /* the blob is not aligned: what follows is checked in a workspace */
    for (size_t i = 0; i < 4 * m->blocks + 2 * m->groups; i++) p->state_work[i] = take(&at);
    blocks = p->state_work;
    zeta = blocks + 4 * m->blocks;
    good = good && scalars_are_good(p, value);
    for (int i = 0; i < 4; i++)
        good = good && matrices_are_good(p, blocks + (size_t)i * m->blocks, i > 1,
                                         i % 2 ? GP_FOLLOWS_DAMPING : GP_FOLLOWS_STIFFNESS);
    good = good && gp_schedule_agrees(m, value[13], blocks, blocks + m->blocks) &&
           gp_schedule_agrees(m, value[15], blocks + 2 * m->blocks, blocks + 3 * m->blocks);
    good = good && ratios_are_good(zeta, 2 * m->groups);
    if (good && value[8] != 0) /* modal coordinates belong to the start parameters */
        good = !memcmp(blocks + 2 * m->blocks, m->stiffness, m->blocks * sizeof(double)) &&
               !memcmp(blocks + 3 * m->blocks, m->damping, m->blocks * sizeof(double)) &&
               (!m->groups || !memcmp(zeta + m->groups, m->zeta, m->groups * sizeof(double)));
    return good ? 0 : refuse(p, "a number in it is out of range.");
}

int gp_state_read(GpInstance *p, const unsigned char *bytes, size_t size, double *extra) {
    const GpModel *m = &p->model;
    const unsigned char *at = bytes + HEADER;
    double value[SCALARS];
    size_t count, same = 1;
    if (gp_state_check(p, bytes, size)) return -1;
    for (size_t i = 0; i < GP_STATE_EXTRA; i++) extra[i] = take(&at);
    for (size_t i = 0; i < SCALARS; i++) value[i] = take(&at);
    for (size_t j = 0; j < m->joints; j++) p->changed[j] = take(&at) != 0;
    for (int i = 0; visit(p, i, &count); i++) {
        double *array = visit(p, i, &count);
        const size_t length = count * sizeof *array;
        if ((i == 2 || i == 3 || i == 5) && length) same = same && !memcmp(array, at, length);
        if (length) memcpy(array, at, length);
        at += length;
    }
    same = same && p->modal == (value[8] != 0);
    p->frequency = value[0], p->frequency_slope = value[1];
    p->source.teeth = value[2], p->source.speed = value[3], p->source.speed_slope = value[4];
    p->source.turns = value[5], p->source.part = value[6], p->source.rest = value[12];
    p->time = value[7], p->modal = value[8] != 0, p->begun = value[10] != 0;
    p->torque = value[13], p->torque_slope = value[14], p->used_torque = value[15];
    p->steps = (unsigned long long)value[11];
    if (gp_schedule_clamped(m, p->torque) != gp_schedule_clamped(m, p->used_torque))
        for (size_t j = 0; j < m->joints; j++) p->changed[j] |= m->joint[j].follows != 0;
    for (size_t i = 0; i < GP_STEP_SIZES; i++) {
        GpDiscrete *d = p->discrete + i;
        d->ready = same && d->ready && d->h == value[SINGLE + 2 * i];
        d->h = value[SINGLE + 2 * i];
        d->used = (unsigned long long)value[SINGLE + 1 + 2 * i];
    }
    gp_system_form(&p->system, m, p->valid_zeta, p->valid_K, p->valid_C);
    gp_instance_restored(p, value[9] == 0);
    return 0;
}
