#include "gp_text.h"

void gp_text_clear(GpText *t) {
    t->length = 0;
    t->text[0] = '\0';
}

static void add_char(GpText *t, char c) {
    if (t->length + 1 < GP_TEXT_SIZE) {
        t->text[t->length++] = c;
        t->text[t->length] = '\0';
    }
}

void gp_text_add(GpText *t, const char *s) {
    while (s && *s) add_char(t, *s++);
}

void gp_text_count(GpText *t, unsigned long long value) {
    char digits[24];
    int n = 0;
    do {
        digits[n++] = (char)('0' + (int)(value % 10));
        value /= 10;
    } while (value);
    while (n) add_char(t, digits[--n]);
}

void gp_text_real(GpText *t, double value) {
    int exponent = 0, last;
    unsigned long long digits;
    char figure[10];
    if (value != value) {
        gp_text_add(t, "NaN");
        return;
    }
    if (value < 0) {
        add_char(t, '-');
        value = -value;
    }
    if (value > 1.7976931348623157e308) {
        gp_text_add(t, "infinity");
        return;
    }
    if (value == 0) {
        add_char(t, '0');
        return;
    }
    while (value >= 10) { value /= 10; exponent++; }
    while (value < 1) { value *= 10; exponent--; }
    digits = (unsigned long long)(value * 1e8 + 0.5);
    if (digits >= 1000000000ULL) { digits /= 10; exponent++; }
    for (last = 8; last >= 0; last--) {
        figure[last] = (char)('0' + (int)(digits % 10));
        digits /= 10;
    }
    for (last = 8; last > 0 && figure[last] == '0'; last--) {}
    add_char(t, figure[0]);
    if (last > 0) add_char(t, '.');
    for (int i = 1; i <= last; i++) add_char(t, figure[i]);
    if (exponent) {
        add_char(t, 'e');
        if (exponent < 0) add_char(t, '-');
        gp_text_count(t, (unsigned long long)(exponent < 0 ? -exponent : exponent));
    }
}
