#ifndef GP_TEXT_H
#define GP_TEXT_H
/* Messages without printf: the Windows build has no full C runtime, and a message must never fail. */
#include <stddef.h>

#include "gp_exact.h"

enum { GP_TEXT_SIZE = 768 };

typedef struct {
    char text[GP_TEXT_SIZE]; /* zero-terminated; cut where it would not fit */
    size_t length;           /* characters used */
} GpText;

void gp_text_clear(GpText *t);
void gp_text_add(GpText *t, const char *s);
void gp_text_count(GpText *t, unsigned long long value);
void gp_text_real(GpText *t, double value); /* 9 significant digits */

#endif
