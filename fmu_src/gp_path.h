#ifndef GP_PATH_H
#define GP_PATH_H
/* Resource locations: file: URIs (percent-encoded UTF-8) to files, on every platform. */
#include <stdio.h>

#include "gp_text.h"

/* Opens FILE in the directory a `file:` URI (or a plain path) names. NULL with a message on failure. */
FILE *gp_open_resource(const char *location, const char *file, GpText *message);

/* The native path of a location, in UTF-8: newly allocated, or NULL with a message.
   `windows`: follow the rules for drive letters and UNC shares; `decode`: resolve %XX. */
char *gp_location_path(const char *location, int windows, int decode, GpText *message);

#endif
