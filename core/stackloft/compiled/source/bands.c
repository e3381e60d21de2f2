/* Grey levels in bands within and beyond a body's boundary (segmenters/slab_level.py says what they are for). */
#include <stdlib.h>
#include <string.h>

#include "bits.h"

enum { MOST_REACH = 32 };

static int eroded_by_square(const bits *mask, bits *out, int reach)
{
    int32_t square[MOST_REACH];
    for (int k = 0; k <= reach; k++)
        square[k] = reach;
    return bits_eroded(mask, out, reach, square);
}

INLINE int64_t gathered(int kind, const pixels *picture, const bits *a, const bits *b, double *values, int64_t room)
{
    int64_t count = 0;
    for (int row = 0; row < a->rows; row++)
        for (int k = 0; k < a->width; k++)
            for (uint64_t left = bits_row(a, row)[k] ^ bits_row(b, row)[k]; left; left &= left - 1) {
                if (count == room)
                    return -1;
                values[count++] = stored_as(kind, picture, row, 64 * k + __builtin_ctzll(left));
            }
    return count;
}

/* Gather the pixels of a mask further from its boundary than `near`, no further than `far`. */
static int64_t band(const pixels *picture, const bits *mask, int near, int far, double *values, int64_t room)
{
    bits outer = {0}, inner = {0};
    int64_t count = -1;
    if (eroded_by_square(mask, &outer, near) && eroded_by_square(mask, &inner, far)) {
#define GATHER(KIND) count = gathered(KIND, picture, &outer, &inner, values, room)
        FOR_KIND(picture->kind, GATHER)
    }
    free(outer.words), free(inner.words);
    return count;
}

/* Gather the levels of both bands; distances are those of chessboards. `values` has room for `room` numbers of
 * the one within, then as many of the one beyond; `counts` out. Returns 0 when room or memory is short. */
EXPORT int stackloft_bands(const pixels *picture, double level, int near, int far, double *values, int64_t room,
                           int64_t *counts)
{
    if (far >= MOST_REACH)
        return 0;
    bits body = bits_above(picture, level);
    counts[0] = counts[1] = -1;
    if (body.words) {
        counts[0] = band(picture, &body, near, far, values, room);
        bits_turn_over(&body);
        counts[1] = band(picture, &body, near, far, values + room, room);
    }
    free(body.words);
    return counts[0] >= 0 && counts[1] >= 0;
}
