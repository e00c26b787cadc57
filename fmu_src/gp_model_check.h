#ifndef GP_MODEL_CHECK_H
#define GP_MODEL_CHECK_H
#include "gp_model.h"

/* NULL, or what is wrong with the contents of a model whose sections are all there: after this every index is in
   range and every number usable. */
const char *gp_model_check(const GpModel *model, size_t text_size);

#endif
