/* model.bin: little-endian, every section padded to 8 bytes.

   header   magic "GEARPATH", u32 version, u32 0x01020304, u64 file size, u32 CRC-32 of all that follows byte 32,
            u32 zero, char guid[40]
   counts   u32 N, groups, joints, rows, blocks, loads, outputs, variables, excitation, text bytes, zero, zero
   sections in the order of `GpModel`: frequency, the doubles, the indices, the records, the text */
#include "gp_model.h"

#include <stdlib.h>
#include <string.h>

#include "gp_linalg.h"

enum { HEADER = 72, COUNTS = 12, VERSION = 1, LARGEST_COUNT = 1 << 13, LARGEST_FILE = 1 << 30 };

static uint32_t crc32_of(const unsigned char *data, size_t size) {
    uint32_t crc = 0xFFFFFFFFu;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int k = 0; k < 8; k++) crc = (crc >> 1) ^ (0xEDB88320u & (0u - (crc & 1u)));
    }
    return ~crc;
}

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
    if (memcmp(m->bytes, "GEARPATH", 8)) return refuse(message, "it is not a Gearpath model.");
    memcpy(word, m->bytes + 8, 8);
    memcpy(&stated, m->bytes + 16, 8);
    memcpy(word + 2, m->bytes + 24, 8);
    if (word[0] != VERSION) return refuse(message, "its format has another version; export the FMU again.");
    if (word[1] != 0x01020304u) return refuse(message, "its byte order is not this machine's.");
    if (stated != size) return refuse(message, "its size is wrong, so it is truncated; unpack the FMU again.");
    if (word[3] != 0 || word[2] != crc32_of(m->bytes + 32, size - 32))
        return refuse(message, "its checksum is wrong, so it was altered; unpack the FMU again.");
    memcpy(m->guid, m->bytes + 32, sizeof m->guid);
    if (m->guid[sizeof m->guid - 1]) return refuse(message, "its GUID is not terminated.");
    return 0;
}

/* The next section of `count` items: its start, or NULL behind the end of the file. */
static const void *section(const GpModel *m, size_t *at, size_t size, size_t count, size_t item) {
    const size_t length = (count * item + 7) / 8 * 8;
    const unsigned char *start = m->bytes + *at;
    if (length > size - *at) return NULL;
    *at += length;
    return start;
}

static int find_sections(GpModel *m, size_t size, size_t *text_size) {
    uint32_t n[COUNTS];
    size_t at = HEADER + 4 * COUNTS;
    const double *frequency;
    memcpy(n, m->bytes + HEADER, sizeof n);
    for (int i = 0; i < COUNTS; i++)
        if (n[i] > (i == 4 || i == 7 || i == 9 ? 1u << 24 : (uint32_t)LARGEST_COUNT)) return -1;
    m->modes = n[0], m->groups = n[1], m->joints = n[2], m->rows = n[3], m->blocks = n[4];
    m->loads = n[5], m->outputs = n[6], m->variables = n[7], m->excitation = n[8], *text_size = n[9];
    if (!m->modes || !m->joints || !m->rows || !m->loads || m->excitation >= m->loads || n[10] || n[11]) return -1;
    frequency = section(m, &at, size, 1, 8);
    if (!frequency) return -1;
    m->frequency = *frequency;
#define GP_SECTION(field, count, item) \
    if (!((field) = section(m, &at, size, count, item))) return -1
    GP_SECTION(m->eigenvalues, m->modes, 8);
    GP_SECTION(m->scale, m->modes, 8);
    GP_SECTION(m->zeta, m->groups, 8);
    GP_SECTION(m->source, m->rows * m->modes, 8);
    GP_SECTION(m->receiver, m->rows * m->modes, 8);
    GP_SECTION(m->stiffness, m->blocks, 8);
    GP_SECTION(m->damping, m->blocks, 8);
    GP_SECTION(m->column, m->loads * m->modes, 8);
    GP_SECTION(m->mesh, m->loads * m->modes, 8);
    GP_SECTION(m->output_rows, m->outputs * m->modes, 8);
    GP_SECTION(m->group, m->modes, 4);
    GP_SECTION(m->is_error, m->loads, 4);
    GP_SECTION(m->rotation, m->rows, 4);
    GP_SECTION(m->joint, m->joints, sizeof(GpJoint));
    GP_SECTION(m->output, m->outputs, sizeof(GpOutput));
    GP_SECTION(m->variable, m->variables, sizeof(GpVariable));
    GP_SECTION(m->text, *text_size, 1);
#undef GP_SECTION
    return at == size ? 0 : -1;
}

static int check_numbers(const GpModel *m) {
    const double *first = m->eigenvalues, *end = m->output_rows + m->outputs * m->modes;
    for (; first < end; first++)
        if (!gp_finite(*first)) return -1;
    if (!gp_finite(m->frequency) || m->frequency <= 0) return -1;
    for (size_t r = 0; r < m->modes; r++) {
        if (m->eigenvalues[r] < 0 || !(m->scale[r] > 0)) return -1;
        if (m->group[r] != GP_NONE && m->group[r] >= m->groups) return -1;
    }
    for (size_t i = 0; i < m->groups; i++)
        if (m->zeta[i] < 0 || m->zeta[i] >= 1) return -1;
    for (size_t i = 0; i < m->loads; i++)
        if (m->is_error[i] > 1) return -1;
    for (size_t i = 0; i < m->rows; i++)
        if (m->rotation[i] > 1) return -1;
    return 0;
}

static int check_joints(const GpModel *m, size_t text_size) {
    size_t row = 0, block = 0;
    if (!text_size || m->text[text_size - 1]) return -1;
    for (size_t i = 0; i < m->joints; i++) {
        const GpJoint *j = m->joint + i;
        const size_t d = j->size;
        if (j->first != row || j->block != block || d == 0 || d > 6 || j->path > 1 || j->zero) return -1;
        if (j->name >= text_size || row + d > m->rows || block + d * d > m->blocks) return -1;
        for (size_t k = 0; k < d * d; k++) {
            const size_t mirror = block + k % d * d + k / d;
            if (m->stiffness[block + k] != m->stiffness[mirror] || m->damping[block + k] != m->damping[mirror])
                return -1;
        }
        row += d;
        block += d * d;
    }
    return row == m->rows && block == m->blocks ? 0 : -1;
}

static int check_outputs(const GpModel *m) {
    for (size_t i = 0; i < m->outputs; i++) {
        const GpOutput *o = m->output + i;
        const int of_joint = o->quantity == GP_FORCE || o->quantity == GP_POWER;
        if (o->quantity >= GP_QUANTITIES || o->zero) return -1;
        if (of_joint ? o->joint >= m->joints || o->dof >= m->joint[o->joint].size
                     : o->joint != GP_NONE || o->dof != 0)
            return -1;
    }
    return 0;
}

static int check_variable(const GpModel *m, const GpVariable *v) {
    switch (v->kind) {
    case GP_INPUT: return v->a < m->loads && !v->b && !v->c;
    case GP_FREQUENCY: return !v->a && !v->b && !v->c;
    case GP_STIFFNESS:
    case GP_DAMPING: return v->a < m->joints && v->b <= v->c && v->c < m->joint[v->a].size;
    case GP_MODAL_DAMPING: return v->a < m->groups && !v->b && !v->c;
    case GP_OUTPUT: return v->a < m->outputs && !v->b && !v->c;
    case GP_ALPHA: return v->a < 3 && !v->b && !v->c;
    case GP_JOINT_ALPHA: return v->a < m->joints && !v->b && !v->c;
    case GP_FRF_REAL:
    case GP_FRF_IMAG: return v->a < m->outputs && m->output[v->a].quantity != GP_POWER && !v->b && !v->c;
    default: return 0;
    }
}

int gp_model_read(GpModel *m, FILE *stream, GpText *message) {
    size_t size = 0, text_size = 0;
    int failed;
    memset(m, 0, sizeof *m);
    if (read_all(m, stream, &size, message)) return -1;
    failed = check_header(m, size, message);
    if (!failed && find_sections(m, size, &text_size))
        failed = refuse(message, "its counts do not fit its size.");
    if (!failed && check_numbers(m)) failed = refuse(message, "a number is out of range.");
    if (!failed && check_joints(m, text_size)) failed = refuse(message, "a joint is wrong.");
    if (!failed && check_outputs(m)) failed = refuse(message, "an output is wrong.");
    for (size_t i = 0; !failed && i < m->variables; i++)
        if (!check_variable(m, m->variable + i)) failed = refuse(message, "a variable is wrong.");
    if (failed) gp_model_free(m);
    return failed;
}

void gp_model_free(GpModel *m) {
    free(m->bytes);
    memset(m, 0, sizeof *m);
}

const char *gp_joint_name(const GpModel *m, size_t joint) { return m->text + m->joint[joint].name; }
