/* Grey levels in bands within and beyond a body's boundary (segmenters/slab_level.py says what they are for). */
#include <stdlib.h>

#include "gather.h"

/* Gather the pixels of a mask further from its boundary than `near`, no further than `far`. */
static int64_t band(const pixels *picture, const bits *mask, int near, int far, double *values, int64_t room)
{
    bits outer = {0}, inner = {0};
    int64_t count = -1;
    if (bits_eroded(mask, &outer, near, NULL) && bits_eroded(mask, &inner, far, NULL)) {
#define GATHER(KIND) count = gathered(KIND, picture, 0.0, &outer, &inner, 1, values, room)
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
