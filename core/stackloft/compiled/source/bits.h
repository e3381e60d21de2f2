/* Masks of one bit a pixel, 64 to a word: a slice's body fits in the processor's nearest cache. */
#ifndef STACKLOFT_BITS_H
#define STACKLOFT_BITS_H

#include <stdint.h>

#include "pixels.h"

typedef struct {
    uint64_t *words; /* rows · width, row after row; the lowest bit is the leftmost pixel */
    int rows, columns, width;
} bits;

/* Return a mask of zeros; its words are NULL when there is no memory. Let it go with free(words). */
bits bits_new(int rows, int columns);

/* Return the pixels above a level; those beyond the last column are 0. */
bits bits_above(const pixels *picture, double level);

static inline int bit_at(const bits *mask, int row, int column)
{
    if (row < 0 || column < 0 || row >= mask->rows || column >= mask->columns)
        return 0;
    return (int)(mask->words[(int64_t)row * mask->width + (column >> 6)] >> (column & 63) & 1);
}

static inline uint64_t *bits_row(const bits *mask, int row)
{
    return mask->words + (int64_t)row * mask->width;
}

int64_t bits_count(const bits *mask);

/* Mask out of: 1 of its last word's bits that are pixels. */
uint64_t bits_last_word(const bits *mask);

/* Make 1 of 0 and 0 of 1. */
void bits_turn_over(bits *mask);

/* out = mask dilated by a disc whose row `dy` off the middle reaches half[|dy|] pixels to either side; by a square
 * where half is NULL. */
int bits_dilated(const bits *mask, bits *out, int radius, const int32_t *half);

/* out = mask eroded by it; beyond the border lies more of the mask. */
int bits_eroded(const bits *mask, bits *out, int radius, const int32_t *half);

/* out = bits of `from` whose first pixel lies `down` rows and `right` columns from out's first one; else 0. */
void bits_placed(const bits *from, bits *out, int down, int right);

#endif
