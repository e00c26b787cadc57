/* What differs between Windows and elsewhere. On Windows the host is linked with ucrtbase only, as the FMU's library is:
   the start-up code and the printf that compilers add would take minutes to compile. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>

int _fltused = 1;
void mainCRTStartup(void);
void mainCRTStartup(void) { exit(host_main()); }

void format(char *text, size_t size, const char *message, va_list arguments) {
    __stdio_common_vsprintf(2 /* end as C99 says */, text, size, message, NULL, arguments);
}

static HMODULE library;

int library_open(const char *path) {
    static wchar_t wide[4096];
    if (!MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, (int)(sizeof wide / sizeof *wide))) return -1;
    library = LoadLibraryW(wide);
    return library ? 0 : -1;
}

Function library_function(const char *name) {
    FARPROC found = GetProcAddress(library, name);
    Function function;
    memcpy(&function, &found, sizeof function);
    return function;
}
#else
#include <dlfcn.h>

int main(void) { return host_main(); }

void format(char *text, size_t size, const char *message, va_list arguments) {
    vsnprintf(text, size, message, arguments);
}

static void *library;

int library_open(const char *path) {
    library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    return library ? 0 : -1;
}

Function library_function(const char *name) {
    void *found = dlsym(library, name);
    Function function;
    memcpy(&function, &found, sizeof function); /* ISO C has no cast for this */
    return function;
}
#endif
