/* What the controller keeps between steps: the table of the cut, and what its estimator knows of it. */
#ifndef UNIT_MEMORY_H
#define UNIT_MEMORY_H

#include "retarder_table.h"

typedef struct {
    retarder_table table;
    retarder_estimate estimate;
} unit_memory;

#endif
