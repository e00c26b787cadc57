/* Fuzzer of resource locations: the rules of this system and, with its file functions replaced, those of Windows. */
#include <wchar.h>

#include "fuzz.h"
#include "gp_path.h"

static size_t longest; /* UTF-16 units that a path may have here */

static FILE *checked_wfopen(const wchar_t *path, const wchar_t *mode) {
    FUZZ_CHECK(wcslen(path) <= longest, "a path grew by being widened");
    for (; *path; path++) FUZZ_CHECK((unsigned long)*path < 0x10000UL, "a unit of UTF-16 does not fit 16 bits");
    FUZZ_CHECK(mode[0] == L'r', "not opened for reading");
    return NULL;
}

#define _WIN32
#define _wfopen checked_wfopen
#define gp_location_path windows_location_path
#define gp_open_resource windows_open_resource
#include "gp_path.c"
#undef _WIN32
#undef gp_location_path
#undef gp_open_resource

/* The path behind a URI in which every byte is encoded is that path. */
static void check_round_trip(const char *path) {
    const size_t length = strlen(path);
    char *uri = malloc(3 * length + 9), *out = uri, *back;
    GpText message;
    FUZZ_CHECK(uri, "no memory");
    out += sprintf(out, "file:///");
    for (size_t i = 0; i < length; i++) out += sprintf(out, "%%%02x", (unsigned)(unsigned char)path[i]);
    gp_text_clear(&message);
    back = gp_location_path(uri, 0, 1, &message);
    FUZZ_CHECK(back && back[0] == '/' && !strcmp(back + 1, path), "percent encoding was not undone");
    free(back);
    free(uri);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char *location = malloc(size + 1);
    FUZZ_CHECK(location, "no memory");
    memcpy(location, data, size);
    location[size] = '\0';
    longest = strlen(location) + 16;
    for (int i = 0; i < 4; i++) {
        GpText message;
        char *path;
        gp_text_clear(&message);
        path = gp_location_path(location, i & 1, i & 2, &message);
        FUZZ_CHECK(path || message.length, "a location was refused without a sentence");
        FUZZ_CHECK(!path || strlen(path) <= strlen(location) + 2, "a path is longer than its location");
        free(path);
    }
    for (int windows = 0; windows < 2 && size % 4 == 0; windows++) { /* opening is slow */
        GpText message;
        FILE *stream = windows ? windows_open_resource(location, "m", &message) : gp_open_resource(location, "m", &message);
        FUZZ_CHECK(stream || message.length, "a file could not be opened and no sentence says so");
        if (stream) fclose(stream);
    }
    check_round_trip(location);
    free(location);
    return 0;
}
