#ifndef GP_STATE_H
#define GP_STATE_H
/* The state of an instance as bytes without pointers: parameters, inputs, coordinates, clock and phase, for the same
   model in any process on any of the platforms.

   header   magic "GPSTATE" and 0, u32 version, u32 0x01020304, u64 size, u32 CRC-32 of all that follows byte 32,
            u32 zero, char guid[40] of the model
   doubles  GP_STATE_EXTRA of the caller's, the scalars, the arrays in the order of `visit` */
#include "gp_instance.h"

enum { GP_STATE_EXTRA = 6 };

size_t gp_state_size(const GpInstance *p);

/* Writes gp_state_size bytes. */
void gp_state_write(GpInstance *p, const double *extra, unsigned char *bytes);

/* 0 with the caller's doubles in `extra` after everything was checked and taken over, or -1 with a message after
   nothing was changed. */
int gp_state_read(GpInstance *p, const unsigned char *bytes, size_t size, double *extra);

/* Whether the bytes are a state of this model: 0, or -1 with a message. */
int gp_state_check(GpInstance *p, const unsigned char *bytes, size_t size);

#endif
