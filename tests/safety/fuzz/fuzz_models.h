/* The models that state and call fuzzers work on: GEARPATH_FUZZ_MODELS/0, 1, 2 ... each hold a model.bin. */
#ifndef FUZZ_MODELS_H
#define FUZZ_MODELS_H
#include "fuzz.h"

enum { FUZZ_MODELS = 8 };

typedef struct {
    char location[512]; /* file: URI */
    char guid[40];
} FuzzModel;

static FuzzModel fuzz_model[FUZZ_MODELS];
static unsigned fuzz_models;

static inline void fuzz_find_models(void) {
    const char *folder = getenv("GEARPATH_FUZZ_MODELS");
    FUZZ_CHECK(folder, "GEARPATH_FUZZ_MODELS names no folder");
    for (; fuzz_models < FUZZ_MODELS; fuzz_models++) {
        FuzzModel *m = fuzz_model + fuzz_models;
        char path[600];
        FILE *stream;
        snprintf(m->location, sizeof m->location, "file://%s/%u", folder, fuzz_models);
        snprintf(path, sizeof path, "%s/%u/model.bin", folder, fuzz_models);
        stream = fopen(path, "rb");
        if (!stream) break;
        fseek(stream, 32, SEEK_SET);
        FUZZ_CHECK(fread(m->guid, sizeof m->guid, 1, stream) == 1, "no GUID");
        fclose(stream);
    }
    FUZZ_CHECK(fuzz_models, "GEARPATH_FUZZ_MODELS holds no model");
}
#endif
