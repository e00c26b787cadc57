/* model.bin: little-endian, every section padded to 8 bytes.

   header   magic "GEARPATH", u32 version, u32 0x01020304, u64 file size, u32 CRC-32 of all that follows byte 32,
            u32 zero, char guid[40]
   counts   u32 N, groups, joints, rows, blocks, loads, outputs, variables, excitation, text bytes, tones,
            source load, pairs, points of the schedule, states of a given system (which has no N), zero
   sections in the order of `find_sections`: the doubles, the indices, the records, the text */
#include "gp_model.h"

#include <stdlib.h>
#include <string.h>

#include "gp_crc.h"
#include "gp_given.h"
#include "gp_model_check.h"

enum { HEADER = 72, COUNTS = 16, VERSION = 4, LARGEST_COUNT = 1 << 13, LARGEST_TABLE = 1 << 24, LARGEST_FILE = 1 << 30 };

static int refuse(GpText *message, const char *why) {
    gp_text_clear(message);
    gp_text_add(message, "resources/model.bin cannot be used: ");
    gp_text_add(message, why);
    return -1;
}

static int read_all(GpModel *m, FILE *stream, size_t *size, GpText *message) {
    size_t room = 1 << 16, used = 0, count;
    unsigned char *bytes = malloc(room);
    while (bytes && (count = fread(bytes + used, 1, room - used, stream)) > 0) {
        used += count;
        if (used == room) {
            unsigned char *larger = room < LARGEST_FILE ? realloc(bytes, 2 * room) : NULL;
            if (!larger) free(bytes);
            bytes = larger;
            room *= 2;
        }
    }
    if (!bytes) return refuse(message, "there is not enough memory for it.");
    m->bytes = bytes;
    *size = used;
    return 0;
}

static int check_header(GpModel *m, size_t size, GpText *message) {
    uint32_t word[4]; /* version, byte order, CRC, zero */
    uint64_t stated;
    if (size < HEADER + 4 * COUNTS) return refuse(message, "it is too short; unpack the FMU again.");
    if (memcmp(m->bytes, "GEARPATH", 8) != 0) return refuse(message, "it is not a Gearpath model.");
    memcpy(word, m->bytes + 8, 8);
    memcpy(&stated, m->bytes + 16, 8);
    memcpy(word + 2, m->bytes + 24, 8);
    if (word[0] != VERSION) return refuse(message, "its format has another version; export the FMU again.");
    if (word[1] != 0x01020304u) return refuse(message, "its byte order is not this machine's.");
    if (stated != size) return refuse(message, "its size is wrong, so it is truncated; unpack the FMU again.");
    if (word[3] != 0 || word[2] != gp_crc32(m->bytes + 32, size - 32))
        return refuse(message, "its checksum is wrong, so it was altered; unpack the FMU again.");
    memcpy(m->guid, m->bytes + 32, sizeof m->guid);
    if (m->guid[sizeof m->guid - 1]) return refuse(message, "its GUID is not terminated.");
    return 0;
}

/* A given system has nothing but inputs, outputs and states, and one of the first or last. */
static int counts_of_given(const GpModel *m) {
    if (m->groups || m->joints || m->rows || m->blocks || m->excitation || m->tones || m->pairs || m->points) return -1;
    return m->source_load == GP_NONE && m->order + m->loads ? 0 : -1;
}

static int counts_of_network(const GpModel *m) {
    if (!m->joints || !m->rows || !m->loads || m->excitation >= m->loads) return -1;
    if (m->pairs && m->pairs != m->modes) return -1;
    if (m->source_load == GP_NONE ? m->tones != 0 : m->source_load >= m->loads) return -1;
    return m->points && m->blocks > LARGEST_TABLE / m->points ? -1 : 0;
}

static int read_counts(GpModel *m, size_t *text_size) {
    uint32_t n[COUNTS];
    memcpy(n, m->bytes + HEADER, sizeof n);
    for (int i = 0; i < COUNTS; i++) {
        const int may_be_large = i == 4 || i == 7 || i == 9;
        if (n[i] > (may_be_large ? 1u << 24 : (uint32_t)LARGEST_COUNT) && !(i == 11 && n[i] == GP_NONE)) return -1;
    }
    m->modes = n[0], m->groups = n[1], m->joints = n[2], m->rows = n[3], m->blocks = n[4];
    m->loads = n[5], m->outputs = n[6], m->variables = n[7], m->excitation = n[8], *text_size = n[9];
    m->tones = n[10], m->source_load = n[11], m->pairs = n[12], m->points = n[13];
    m->order = gp_is_given(m) ? n[14] : 2 * m->modes;
    m->states = m->order + (m->source_load != GP_NONE);
    if (n[15] || (n[14] && !gp_is_given(m))) return -1;
    return gp_is_given(m) ? counts_of_given(m) : counts_of_network(m);
}

/* The next section of `count` items: its start, or NULL behind the end of the file. */
static const void *section(const GpModel *m, size_t *at, size_t size, size_t count, size_t item) {
    const size_t length = (count * item + 7) / 8 * 8;
    const unsigned char *start = m->bytes + *at;
    if (length > size - *at) return NULL;
    *at += length;
    return start;
}

static int find_sections(GpModel *m, size_t size, size_t text_size) {
    const size_t given = gp_is_given(m) ? m->order : 0, rows = gp_is_given(m) ? m->outputs : 0;
    size_t at = HEADER + 4 * COUNTS;
    const double *starts;
#define GP_SECTION(field, count, item) \
    if (!((field) = section(m, &at, size, count, item))) return -1
    GP_SECTION(starts, 4, 8);
    m->frequency = starts[0], m->speed = starts[1], m->teeth = starts[2], m->start_torque = starts[3];
    GP_SECTION(m->eigenvalues, m->modes, 8);
    GP_SECTION(m->scale, m->modes, 8);
    GP_SECTION(m->nominal, m->modes + given, 8);
    GP_SECTION(m->zeta, m->groups, 8);
    GP_SECTION(m->share, m->groups * m->modes, 8);
    GP_SECTION(m->source, m->rows * m->modes, 8);
    GP_SECTION(m->receiver, m->rows * m->modes, 8);
    GP_SECTION(m->stiffness, m->blocks, 8);
    GP_SECTION(m->damping, m->blocks, 8);
    GP_SECTION(m->column, m->loads * m->modes, 8);
    GP_SECTION(m->mesh, m->loads * m->modes, 8);
    GP_SECTION(m->output_rows, m->outputs * m->modes, 8);
    GP_SECTION(m->pole, m->pairs, sizeof(GpPole));
    GP_SECTION(m->shape, 2 * m->pairs * m->modes, 8);
    GP_SECTION(m->tone, m->tones, sizeof(GpTone));
    GP_SECTION(m->torque, m->points, 8);
    GP_SECTION(m->stiffness_at, m->points * m->blocks, 8);
    GP_SECTION(m->damping_at, m->points * m->blocks, 8);
    GP_SECTION(m->A, given * given, 8);
    GP_SECTION(m->B, given * m->loads, 8);
    GP_SECTION(m->C, rows * given, 8);
    GP_SECTION(m->D, rows * m->loads, 8);
    GP_SECTION(m->unit, gp_is_given(m) ? given + m->loads : 0, 8);
    GP_SECTION(m->pair_kind, m->pairs, 4);
    GP_SECTION(m->is_error, m->loads, 4);
    GP_SECTION(m->rotation, m->rows, 4);
    GP_SECTION(m->joint, m->joints, sizeof(GpJoint));
    GP_SECTION(m->output, m->outputs, sizeof(GpOutput));
    GP_SECTION(m->variable, m->variables, sizeof(GpVariable));
    GP_SECTION(m->text, text_size, 1);
#undef GP_SECTION
    return at == size ? 0 : -1;
}

int gp_model_read(GpModel *m, FILE *stream, GpText *message) {
    size_t size = 0, text_size = 0;
    const char *wrong = NULL;
    int failed;
    memset(m, 0, sizeof *m);
    if (read_all(m, stream, &size, message)) return -1;
    failed = check_header(m, size, message);
    if (!failed && (read_counts(m, &text_size) || find_sections(m, size, text_size)))
        failed = refuse(message, "its counts do not fit its size.");
    if (!failed) wrong = gp_model_check(m, text_size);
    if (wrong) failed = refuse(message, wrong);
    if (failed) {
        gp_model_free(m);
        return failed;
    }
    for (size_t i = 0; i < m->outputs; i++) m->linear += m->output[i].quantity != GP_POWER;
    return 0;
}

void gp_model_free(GpModel *m) {
    free(m->bytes);
    memset(m, 0, sizeof *m);
}

size_t gp_variable_size(const GpModel *m, const GpVariable *v) {
    const size_t d = v->kind == GP_STIFFNESS_MATRIX || v->kind == GP_DAMPING_MATRIX || v->kind == GP_PORT_FORCES ||
                             v->kind == GP_PORT_VELOCITIES
                         ? m->joint[v->a].size
                         : 0;
    switch (v->kind) {
    case GP_STIFFNESS_MATRIX:
    case GP_DAMPING_MATRIX: return d * d;
    case GP_PORT_FORCES:
    case GP_PORT_VELOCITIES: return d;
    case GP_STATES:
    case GP_DERIVATIVES: return m->states;
    case GP_MATRIX_A: return m->order * m->order;
    case GP_MATRIX_B: return m->order * m->loads;
    case GP_MATRIX_C: return m->linear * m->order;
    case GP_MATRIX_D: return m->linear * m->loads;
    default: return 1;
    }
}

static GpVariable scalar(uint32_t kind, size_t a, size_t b, size_t c) {
    GpVariable v = {0, 0, 0, 0, 0, 0};
    v.kind = kind;
    v.a = (uint32_t)a;
    v.b = (uint32_t)b;
    v.c = (uint32_t)c;
    return v;
}

GpVariable gp_variable_element(const GpModel *m, const GpVariable *v, size_t i) {
    size_t d, row, column;
    switch (v->kind) {
    case GP_STIFFNESS_MATRIX:
    case GP_DAMPING_MATRIX:
        d = m->joint[v->a].size;
        row = i / d < i % d ? i / d : i % d; /* the matrix is symmetric: the entry in its upper half */
        column = i / d + i % d - row;
        return scalar(v->kind == GP_STIFFNESS_MATRIX ? GP_STIFFNESS : GP_DAMPING, v->a, row, column);
    case GP_PORT_FORCES: return scalar(GP_PORT_FORCE, v->a, i, 0);
    case GP_PORT_VELOCITIES: return scalar(GP_PORT_VELOCITY, v->a, i, 0);
    case GP_STATES: return scalar(GP_STATE, i, 0, 0);
    case GP_DERIVATIVES: return scalar(GP_DERIVATIVE, i, 0, 0);
    case GP_MATRIX_A:
    case GP_MATRIX_C:
        d = m->order;
        return scalar(v->kind == GP_MATRIX_A ? GP_ENTRY_A : GP_ENTRY_C, 0, i / d, i % d);
    case GP_MATRIX_B:
    case GP_MATRIX_D:
        return scalar(v->kind == GP_MATRIX_B ? GP_ENTRY_B : GP_ENTRY_D, 0, i / m->loads, i % m->loads);
    default: return *v;
    }
}

const char *gp_variable_name(const GpModel *m, size_t reference) { return m->text + m->variable[reference].name; }
const char *gp_joint_name(const GpModel *m, size_t joint) { return m->text + m->joint[joint].name; }
