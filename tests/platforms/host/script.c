/* The script's words and numbers, and the output's. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "host.h"

static const char DIGITS[] = "0123456789abcdef";
static char *text, *line, *next; /* the script, the rest of this line, the next one */

void script_fail(const char *what) {
    fputs("host: ", stderr);
    fputs(what, stderr);
    fputs("\n", stderr);
    fflush(stdout);
    exit(2);
}

void *script_memory(size_t count, size_t size) {
    void *memory = calloc(count ? count : 1, size);
    if (!memory) script_fail("not enough memory");
    return memory;
}

int script_read(void) {
    size_t room = 1 << 16, length = 0, got;
    text = script_memory(room, 1);
    while ((got = fread(text + length, 1, room - length - 1, stdin)) > 0) {
        length += got;
        if (length + 1 < room) continue;
        room *= 2;
        text = realloc(text, room);
        if (!text) script_fail("not enough memory");
    }
    text[length] = '\0';
    next = text;
    return ferror(stdin) ? -1 : 0;
}

int script_line(void) {
    do {
        line = next;
        if (!*line) {
            free(text);
            return 0;
        }
        next = line + strcspn(line, "\r\n");
        if (*next) *next++ = '\0';
    } while (!*line);
    return 1;
}

const char *script_word(void) {
    char *word = line + strspn(line, " ");
    line = word + strcspn(word, " ");
    if (line == word) script_fail("a word is missing in the script");
    if (*line) *line++ = '\0';
    return word;
}

const char *script_rest(void) { return line; }

size_t script_count(void) {
    const char *word = script_word();
    size_t number = 0;
    for (; *word; word++) {
        if (*word < '0' || *word > '9') script_fail("the script has another word where a number should be");
        number = 10 * number + (size_t)(*word - '0');
    }
    return number;
}

static unsigned int hexadecimal(char c) {
    const char *found = c ? strchr(DIGITS, c) : NULL;
    if (!found) script_fail("the script has another word where hexadecimal digits should be");
    return (unsigned int)(found - DIGITS);
}

double script_real(void) {
    const char *word = script_word();
    uint64_t bits = 0;
    double value;
    if (strlen(word) != 16) script_fail("a real number has 16 hexadecimal digits");
    for (; *word; word++) bits = bits << 4 | hexadecimal(*word);
    memcpy(&value, &bits, sizeof value);
    return value;
}

void script_reals(double *value, size_t count) {
    for (size_t i = 0; i < count; i++) value[i] = script_real();
}

void script_references(unsigned int *reference, size_t count) {
    for (size_t i = 0; i < count; i++) reference[i] = (unsigned int)script_count();
}

unsigned char *script_bytes(size_t *count) {
    const char *digits = script_word();
    unsigned char *byte;
    *count = strlen(digits) / 2;
    byte = script_memory(*count, 1);
    for (size_t i = 0; i < *count; i++)
        byte[i] = (unsigned char)(hexadecimal(digits[2 * i]) << 4 | hexadecimal(digits[2 * i + 1]));
    return byte;
}

void write_text(const char *words) { fputs(words, stdout); }

void write_count(size_t number) {
    char digits[24], *first = digits + sizeof digits - 1;
    *first = '\0';
    do {
        *--first = (char)('0' + number % 10);
        number /= 10;
    } while (number);
    write_text(" ");
    write_text(first);
}

void write_reals(const double *value, size_t count) {
    for (size_t i = 0; i < count; i++) {
        char digits[18];
        uint64_t bits;
        memcpy(&bits, value + i, sizeof bits);
        digits[0] = ' ';
        for (int k = 16; k > 0; k--, bits >>= 4) digits[k] = DIGITS[bits & 15];
        digits[17] = '\0';
        write_text(digits);
    }
}

void write_bytes(const unsigned char *byte, size_t count) {
    write_text(" ");
    for (size_t i = 0; i < count; i++) {
        const char digits[3] = {DIGITS[byte[i] >> 4], DIGITS[byte[i] & 15], '\0'};
        write_text(digits);
    }
}
