#include "gp_path.h"

#include <stdlib.h>
#include <string.h>

static int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

static char lower(char c) { return (char)(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c); }

static int starts_with(const char *s, const char *prefix) {
    for (; *prefix; s++, prefix++)
        if (lower(*s) != *prefix) return 0;
    return 1;
}

static int is_letter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

/* A drive letter at the start of s: "C:" or, in old URIs, "C|", and then a separator or the end. */
static int is_drive(const char *s) {
    return is_letter(s[0]) && (s[1] == ':' || s[1] == '|') && (s[2] == '/' || s[2] == '\\' || !s[2]);
}

/* The path part of a file URI. A host other than localhost is a UNC server: `*unc` is set and the host kept. */
static const char *after_scheme(const char *s, int windows, int *unc, GpText *message) {
    s += 5; /* file: */
    if (s[0] != '/' || s[1] != '/') return s;
    s += 2;
    if (starts_with(s, "localhost/")) return s + 9;
    if (*s == '/' || (windows && is_drive(s))) {
        /* file:////server/share keeps two slashes: a UNC path as well */
        return s;
    }
    if (!windows) {
        gp_text_add(message, "The resource location names another host, which only works on Windows: ");
        return NULL;
    }
    *unc = 1;
    return s;
}

char *gp_location_path(const char *location, int windows, int decode, GpText *message) {
    const char *s = location;
    char *path, *out;
    int unc = 0;
    if (starts_with(s, "file:")) {
        s = after_scheme(s, windows, &unc, message);
        if (!s) return NULL;
    } else {
        decode = 0; /* a plain path: what some importers pass */
    }
    path = malloc(strlen(s) + 3);
    if (!path) {
        gp_text_add(message, "There is not enough memory to decode the resource location: ");
        return NULL;
    }
    out = path;
    if (unc) {
        *out++ = '/';
        *out++ = '/';
    }
    /* '+', '#' and '?' stand for themselves: a resource location has neither query nor fragment. A '%' that
       does not start a valid triplet does too, because some importers do not encode. */
    while (*s) {
        int high = decode && *s == '%' ? hex_digit(s[1]) : -1;
        int low = high >= 0 ? hex_digit(s[2]) : -1;
        if (low >= 0) {
            if (high == 0 && low == 0) {
                gp_text_add(message, "The resource location contains a zero byte: ");
                free(path);
                return NULL;
            }
            *out++ = (char)(high * 16 + low);
            s += 3;
        } else {
            *out++ = *s++;
        }
    }
    *out = '\0';
    if (windows && path[0] == '/' && is_drive(path + 1)) memmove(path, path + 1, strlen(path));
    if (windows && is_drive(path)) path[1] = ':';
    return path;
}

#ifdef _WIN32
#include <wchar.h>

/* UTF-8 to UTF-16; a malformed byte becomes U+FFFD, which no file has. `wide` holds strlen(s) + 1 units. */
static void widen(const char *text, wchar_t *wide) {
    const unsigned char *s = (const unsigned char *)text;
    while (*s) {
        unsigned long point = *s++;
        int more = point < 0x80 ? 0 : point >= 0xF0 ? 3 : point >= 0xE0 ? 2 : point >= 0xC2 ? 1 : -1;
        if (more > 0) point &= 0x3FUL >> more;
        for (int i = 0; i < more; i++) {
            if ((*s & 0xC0) != 0x80) { more = -1; break; }
            point = (point << 6) | (*s++ & 0x3FUL);
        }
        if (more < 0 || point > 0x10FFFFUL || (point >= 0xD800UL && point < 0xE000UL)) point = 0xFFFDUL;
        if (point >= 0x10000UL) {
            point -= 0x10000UL;
            *wide++ = (wchar_t)(0xD800UL + (point >> 10));
            point = 0xDC00UL + (point & 0x3FFUL);
        }
        *wide++ = (wchar_t)point;
    }
    *wide = 0;
}

static FILE *open_native(const char *path) {
    wchar_t *wide = malloc((strlen(path) + 1) * sizeof *wide);
    FILE *file;
    if (!wide) return NULL;
    widen(path, wide);
    file = _wfopen(wide, L"rb");
    free(wide);
    return file;
}
enum { ON_WINDOWS = 1 };
#else
static FILE *open_native(const char *path) { return fopen(path, "rb"); }
enum { ON_WINDOWS = 0 };
#endif

FILE *gp_open_resource(const char *location, const char *file, GpText *message) {
    FILE *stream = NULL;
    /* Decoded as the standard says first; as written where an importer passed the path unencoded. */
    for (int decode = 1; decode >= 0 && !stream; decode--) {
        char *path, *full;
        size_t length;
        gp_text_clear(message);
        path = gp_location_path(location, ON_WINDOWS, decode, message);
        if (!path) break;
        length = strlen(path);
        full = malloc(length + strlen(file) + 2);
        if (full) {
            memcpy(full, path, length + 1);
            if (length && full[length - 1] != '/' && full[length - 1] != '\\') full[length++] = '/';
            memcpy(full + length, file, strlen(file) + 1);
            stream = open_native(full);
            free(full);
        }
        free(path);
    }
    if (stream) {
        gp_text_clear(message);
        return stream;
    }
    if (!message->length) {
        gp_text_add(message, "The file ");
        gp_text_add(message, file);
        gp_text_add(message, " cannot be opened; check that the FMU was unpacked completely: ");
    }
    gp_text_add(message, location);
    return NULL;
}
