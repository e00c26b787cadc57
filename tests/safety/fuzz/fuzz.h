/* What the fuzzers share: reading bytes as arguments, sealing files, and saying what went wrong. */
#ifndef FUZZ_H
#define FUZZ_H
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gp_crc.h"
#include "gp_instance.h"
#include "gp_state.h"

/* The sanitizers report where `abort` was called from. */
#define FUZZ_CHECK(good, sentence)                                             \
    do {                                                                       \
        if (good) break;                                                       \
        fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, sentence);          \
        abort();                                                               \
    } while (0)

typedef struct {
    const uint8_t *at, *end;
} Bytes;

static inline size_t fuzz_left(const Bytes *b) { return (size_t)(b->end - b->at); }

static inline unsigned fuzz_byte(Bytes *b) { return b->at < b->end ? *b->at++ : 0; }

/* Numbers at which code goes wrong, or any number. */
static inline double fuzz_double(Bytes *b) {
    static const double known[] = {0,       1,       -1,     1e-6,    1e-5,    1e-3, 0.5,  60,       1e3,  1e8,   -1e-9, NAN,
                                   INFINITY, -INFINITY, 1e308, -1e308, 5e-324, 2,    1e12, 0.999999, 500.0, 1e-12, 1e5,   3};
    const unsigned kind = fuzz_byte(b);
    double value = 0;
    if (kind < 0xC0) return known[kind % (sizeof known / sizeof *known)];
    if (kind < 0xF0) return ((int)fuzz_byte(b) - 128) * (kind < 0xD0 ? 1e-7 : kind < 0xE0 ? 1e-2 : 1e6);
    for (int i = 0; i < 8; i++) ((uint8_t *)&value)[i] = (uint8_t)fuzz_byte(b);
    return value;
}

/* A copy of exactly this size, so that every read behind it is found. */
static inline void *fuzz_copy(const void *from, size_t size) {
    void *copy = malloc(size ? size : 1);
    FUZZ_CHECK(copy, "no memory");
    if (size) memcpy(copy, from, size);
    return copy;
}

/* The size and the checksum in the header of model.bin or of a state, made right. */
static inline void fuzz_seal(uint8_t *bytes, size_t size) {
    const uint64_t stated = size;
    uint32_t crc;
    if (size < 72) return;
    crc = gp_crc32(bytes + 32, size - 32);
    memcpy(bytes + 16, &stated, 8);
    memcpy(bytes + 24, &crc, 4);
}

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);

/* Half of the mutations put a telling number in the place of one that is there. */
static inline size_t fuzz_mutate_numbers(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    static const double reals[] = {0, 1, -1, 1e-300, 5e-324, 1e308, -1e308, NAN, INFINITY, 1e-8, 1e6, 0.5, 1e16, 4.6e18, -0.0, 2};
    static const uint32_t words[] = {0, 1, 2, 3, 6, 7, 8191, 8192, 8193, 0x7FFFFFFF, 0xFFFFFFFF, 0x80000000, 1u << 24, 64, 73, 26};
    const unsigned choice = seed >> 2;
    if (size < 16 || seed % 4 > 1) return LLVMFuzzerMutate(data, size, max_size);
    if (seed % 4)
        memcpy(data + choice / 16 % (size / 8) * 8, reals + choice % 16, 8);
    else
        memcpy(data + choice / 16 % (size / 4) * 4, words + choice % 16, 4);
    return size;
}

/* Every scalar and array that can be got, into `values` (room for `room`); failures must come with a sentence and
   successes with numbers. Returns how many were written; a variable that failed counts as zeros. */
static inline size_t fuzz_get_all(GpInstance *p, double *values, size_t room) {
    size_t used = 0;
    for (unsigned reference = 0; reference < p->model.variables; reference++) {
        const size_t size = gp_variable_size(&p->model, p->model.variable + reference);
        if (used + size > room) break;
        if (gp_get(p, &reference, 1, values + used, size)) {
            FUZZ_CHECK(p->message.length, "a get failed without a sentence");
            memset(values + used, 0, size * sizeof *values);
        }
        for (size_t i = 0; i < size; i++)
            FUZZ_CHECK(isfinite(values[used + i]), "a get succeeded with a number that is not finite");
        used += size;
    }
    return used;
}

/* Whether a step of h is quick: a mesh source that turns fast divides it into up to a million parts. */
static inline int fuzz_is_quick(const GpInstance *p, double h) {
    if (!(h > 0)) return 1; /* refused at once */
    const size_t parts = p->model.source_load == GP_NONE ? 0 : gp_source_substeps(&p->source, &p->model, h);
    return parts < 10 || parts == GP_NONE;
}
#endif
