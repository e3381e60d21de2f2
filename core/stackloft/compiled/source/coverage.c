/* What a slice adds to a body's volume by partly filled pixels: counts and sums over the zone about its edge
 * (integrators/partial_volume.py says what they are for). */
#include <stdlib.h>
#include <string.h>

#include "bits.h"

typedef struct {
    const pixels *picture; /* NULL: there is no such slice */
    double level;
    int64_t down, right; /* from the current picture's first pixel to its own */
} beside;

/* Narrow `common` to what the slice beside shows too, and widen `united` by it. */
static int take_beside(const beside *other, bits *common, bits *united)
{
    int64_t words = (int64_t)common->rows * common->width;
    if (!other->picture) {
        memset(common->words, 0, (size_t)words * sizeof(uint64_t));
        return 1;
    }
    bits shown = bits_above(other->picture, other->level), here = bits_new(common->rows, common->columns);
    int done = shown.words && here.words;
    if (done) {
        bits_placed(&shown, &here, (int)other->down, (int)other->right);
        for (int64_t k = 0; k < words; k++) {
            common->words[k] &= here.words[k];
            united->words[k] |= here.words[k];
        }
    }
    free(shown.words), free(here.words);
    return done;
}

static void sum_up(const pixels *picture, double level, const bits *common, const bits *inside, const bits *near,
                   double *sums)
{
    double edge = 0.0, all = 0.0, full = 0.0, full_grey = 0.0;
    for (int row = 0; row < near->rows; row++)
        for (int k = 0; k < near->width; k++) {
            int64_t at = (int64_t)row * near->width + k;
            uint64_t between = near->words[at] ^ inside->words[at], filled = common->words[at];
            for (; between; between &= between - 1) {
                int bit = __builtin_ctzll(between);
                double value = grey(picture, row, 64 * k + bit) - level;
                edge += 1.0, all += value;
                if (filled >> bit & 1)
                    full += 1.0, full_grey += value;
            }
        }
    sums[0] = (double)bits_count(inside);
    sums[1] = edge, sums[2] = all, sums[3] = full, sums[4] = full_grey;
}

/* Spread 64 bits over as many bytes, the lowest into the first; four at a time by one multiplication. */
static void spread_over(uint64_t word, uint8_t *to)
{
    for (int k = 0; k < 64; k += 4) {
        uint32_t four = (uint32_t)(word >> k & 15) * UINT32_C(0x00204081) & UINT32_C(0x01010101);
        for (int byte = 0; byte < 4; byte++)
            to[k + byte] = (uint8_t)(four >> (8 * byte));
    }
}

static void unpacked(const bits *mask, uint8_t *to)
{
    uint8_t last[64];
    for (int row = 0; row < mask->rows; row++, to += mask->columns) {
        const uint64_t *words = bits_row(mask, row);
        int whole = mask->columns / 64;
        for (int k = 0; k < whole; k++)
            spread_over(words[k], to + 64 * k);
        if (whole < mask->width) {
            spread_over(words[whole], last);
            memcpy(to + 64 * whole, last, (size_t)(mask->columns - 64 * whole));
        }
    }
}

/* Sum a slice up, given the slices before and after.
 *
 * half    reach of each row of the disc by which the zone is wide, from the middle one outwards
 * sums    out: pixels inside, in the edge zone, the zone's field, its pixels that are at most full, their field
 * masks   out, or NULL: inside, inside with the zone, common to the three slices; a byte a pixel
 *
 * Returns 0 when memory is short.
 */
EXPORT int stackloft_coverage(const pixels *picture, double level, const beside *before, const beside *after,
                              int radius, const int32_t *half, double *sums, uint8_t *masks)
{
    bits common = bits_above(picture, level), united = bits_new(picture->rows, picture->columns);
    bits inside = {0}, near = {0};
    int done = common.words && united.words;
    if (done) {
        memcpy(united.words, common.words, (size_t)common.rows * (size_t)common.width * sizeof(uint64_t));
        done = take_beside(before, &common, &united) && take_beside(after, &common, &united) &&
               bits_eroded(&common, &inside, radius, half) && bits_dilated(&united, &near, radius, half);
    }
    if (done) {
        sum_up(picture, level, &common, &inside, &near, sums);
        int64_t size = (int64_t)common.rows * common.columns;
        if (masks) {
            unpacked(&inside, masks);
            unpacked(&near, masks + size);
            unpacked(&common, masks + 2 * size);
        }
    }
    free(common.words), free(united.words), free(inside.words), free(near.words);
    return done;
}
