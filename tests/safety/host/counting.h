/* A C host that counts allocations: linked with -Wl,--wrap for malloc, calloc, realloc and free, so that only calls of the
   runtime and of the host itself are counted, not those inside the C library. */
#ifndef COUNTING_H
#define COUNTING_H
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static long allocations, frees; /* since the start */
static int armed;               /* whether an allocation or a free is an error now */
static const char *call = "";   /* the call under way */
static int faults;

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *old, size_t size);
void __real_free(void *old);

static void note(const char *function, int allocates) {
    if (allocates) allocations++;
    else frees++;
    if (!armed) return;
    printf("%s in %s\n", function, call);
    faults++;
}

void *__wrap_malloc(size_t size) {
    note("malloc", 1);
    return __real_malloc(size);
}
void *__wrap_calloc(size_t items, size_t size) {
    note("calloc", 1);
    return __real_calloc(items, size);
}
void *__wrap_realloc(void *old, size_t size) {
    note("realloc", 1);
    if (old) frees++;
    return __real_realloc(old, size);
}
void __wrap_free(void *old) {
    if (old) note("free", 0);
    __real_free(old);
}

/* Makes a call that must not allocate and returns its status; FREELY one that may. */
#define STRICTLY(expression) (call = #expression, armed = 1, check((int)(expression), 0))
#define FREELY(expression) check((int)(expression), 0)
#define FAILING(expression) (call = #expression, armed = 1, check((int)(expression), 3))

static int calls;

static void check(int status, int wanted) {
    armed = 0;
    calls++;
    if (status == wanted) return;
    printf("status %d instead of %d in %s\n", status, wanted, call);
    faults++;
}

enum { MANY = 1 << 12, VALUES = 1 << 16 };

/* Variables of one role: value references, and how many values they have in all. */
typedef struct {
    unsigned reference[MANY];
    size_t size[MANY]; /* of each */
    size_t count, values;
} List;

static List inputs, parameters, outputs, all;
static double value[VALUES], seed[VALUES], result[VALUES];

static void add(List *list, unsigned reference, size_t size) {
    if (list->count == MANY || list->values + size > VALUES) exit(3);
    list->reference[list->count] = reference;
    list->size[list->count++] = size;
    list->values += size;
}

/* Lines "ROLE REFERENCE SIZE" with the role i(nput), p(arameter), o(utput) or x (only to be read). */
static void read_variables(const char *path) {
    FILE *stream = fopen(path, "r");
    unsigned reference;
    size_t size;
    char role;
    if (!stream) exit(3);
    while (fscanf(stream, " %c %u %zu", &role, &reference, &size) == 3) {
        if (role == 'i') add(&inputs, reference, size);
        if (role == 'p') add(&parameters, reference, size);
        if (role == 'o') add(&outputs, reference, size);
        add(&all, reference, size);
    }
    fclose(stream);
}

/* What remains must be nothing: everything allocated has been freed. */
static int summary(void) {
    printf("%d calls, %ld allocations, %ld frees, %d faults\n", calls, allocations, frees, faults);
    return faults || allocations != frees;
}
#endif
