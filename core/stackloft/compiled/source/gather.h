/* Grey levels gathered where two masks differ. */
#ifndef STACKLOFT_GATHER_H
#define STACKLOFT_GATHER_H

#include "bits.h"

/* Write the grey levels, less `level`, where masks of every `step`-th pixel of every `step`-th row differ; return how
 * many there are, or -1 when there is no room for them. */
INLINE int64_t gathered(int kind, const pixels *picture, double level, const bits *a, const bits *b, int step,
                        double *values, int64_t room)
{
    int64_t count = 0;
    for (int row = 0; row < a->rows; row++)
        for (int k = 0; k < a->width; k++)
            for (uint64_t left = bits_row(a, row)[k] ^ bits_row(b, row)[k]; left; left &= left - 1) {
                if (count == room)
                    return -1;
                int column = 64 * k + __builtin_ctzll(left);
                values[count++] = grey_as(kind, picture, row * step, column * step) - level;
            }
    return count;
}

#endif
