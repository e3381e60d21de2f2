#include "bits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bits bits_new(int rows, int columns)
{
    bits mask = {NULL, rows, columns, (columns + 63) / 64};
    mask.words = calloc((size_t)rows * (size_t)mask.width + 1, sizeof(uint64_t));
    return mask;
}

/* Gather eight bytes of 0 or 1 into the eight lowest bits, the first byte into the lowest. */
static inline uint64_t gathered(const uint8_t *bytes)
{
    uint64_t eight;
    memcpy(&eight, bytes, 8);
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    eight = __builtin_bswap64(eight);
#endif
    return (eight * UINT64_C(0x0102040810204080)) >> 56;
}

/* A row's comparison for one kind of number, 64 pixels at a time so that the compiler uses wide registers. */
#define ROW_ABOVE(NAME, TYPE)                                                                        \
    TUNED static void NAME(const char *from, int columns, TYPE level, uint64_t *words)               \
    {                                                                                                \
        const TYPE *at = (const TYPE *)from;                                                         \
        uint8_t flag[64];                                                                            \
        int column = 0;                                                                              \
        for (; column + 64 <= columns; column += 64, at += 64) {                                     \
            for (int k = 0; k < 64; k++)                                                             \
                flag[k] = at[k] > level;                                                             \
            uint64_t word = 0;                                                                       \
            for (int k = 0; k < 8; k++)                                                              \
                word |= gathered(flag + 8 * k) << (8 * k);                                           \
            *words++ = word;                                                                         \
        }                                                                                            \
        if (column < columns) {                                                                      \
            uint64_t word = 0;                                                                       \
            for (int k = 0; column + k < columns; k++)                                               \
                word |= (uint64_t)(at[k] > level) << k;                                              \
            *words = word;                                                                           \
        }                                                                                            \
    }

#if defined(__SSE2__)
#include <emmintrin.h>

/* A scan's usual kind, sixteen pixels at a time. */
static void row_above_int16(const char *from, int columns, int16_t level, uint64_t *words)
{
    const int16_t *at = (const int16_t *)from;
    const __m128i limit = _mm_set1_epi16(level);
    int column = 0;
    for (; column + 64 <= columns; column += 64, at += 64) {
        uint64_t word = 0;
        for (int k = 0; k < 64; k += 16) {
            __m128i first = _mm_cmpgt_epi16(_mm_loadu_si128((const __m128i *)(at + k)), limit);
            __m128i second = _mm_cmpgt_epi16(_mm_loadu_si128((const __m128i *)(at + k + 8)), limit);
            word |= (uint64_t)(uint32_t)_mm_movemask_epi8(_mm_packs_epi16(first, second)) << k;
        }
        *words++ = word;
    }
    if (column < columns) {
        uint64_t word = 0;
        for (int k = 0; column + k < columns; k++)
            word |= (uint64_t)(at[k] > level) << k;
        *words = word;
    }
}
#else
ROW_ABOVE(row_above_int16, int16_t)
#endif
ROW_ABOVE(row_above_uint16, uint16_t)
ROW_ABOVE(row_above_uint8, uint8_t)
ROW_ABOVE(row_above_int8, int8_t)
ROW_ABOVE(row_above_int32, int32_t)
ROW_ABOVE(row_above_float32, float)
ROW_ABOVE(row_above_float64, double)

/* Whole numbers lie above a level where they lie above the whole number below it. */
static int whole_level(double level, double least, double most, int32_t *whole)
{
    double below = floor(level);
    if (below >= most)
        return 1; /* none can lie above */
    *whole = below < least ? (int32_t)least : (int32_t)below;
    return below < least ? -1 : 0;
}

static void all_above(bits *mask)
{
    memset(mask->words, 0xff, (size_t)mask->rows * (size_t)mask->width * sizeof(uint64_t));
    for (int row = 0; row < mask->rows && mask->width; row++)
        bits_row(mask, row)[mask->width - 1] = bits_last_word(mask);
}

bits bits_above(const pixels *p, double level)
{
    static const double least[] = {-32768, 0, 0, -128, -2147483648.0};
    static const double most[] = {32767, 65535, 255, 127, 2147483647.0};
    bits mask = bits_new(p->rows, p->columns);
    if (!mask.words)
        return mask;
    int32_t whole = 0;
    if (p->kind <= INT32) {
        int side = isfinite(level) ? whole_level(level, least[p->kind], most[p->kind], &whole)
                                   : (level < 0 ? -1 : 1);
        if (side < 0)
            all_above(&mask);
        if (side)
            return mask;
    }
    for (int row = 0; row < p->rows; row++) {
        const char *from = p->first + row * p->stride;
        uint64_t *to = bits_row(&mask, row);
        switch (p->kind) {
        case INT16: row_above_int16(from, p->columns, (int16_t)whole, to); break;
        case UINT16: row_above_uint16(from, p->columns, (uint16_t)whole, to); break;
        case UINT8: row_above_uint8(from, p->columns, (uint8_t)whole, to); break;
        case INT8: row_above_int8(from, p->columns, (int8_t)whole, to); break;
        case INT32: row_above_int32(from, p->columns, whole, to); break;
        case FLOAT32: row_above_float32(from, p->columns, (float)level, to); break;
        default: row_above_float64(from, p->columns, level, to);
        }
    }
    return mask;
}

TUNED int64_t bits_count(const bits *mask)
{
    int64_t count = 0, words = (int64_t)mask->rows * mask->width;
    for (int64_t k = 0; k < words; k++)
        count += __builtin_popcountll(mask->words[k]);
    return count;
}

uint64_t bits_last_word(const bits *mask)
{
    int rest = mask->columns & 63;
    return rest ? (UINT64_C(1) << rest) - 1 : ~UINT64_C(0);
}

/* Spread every row by one pixel to either side, in place. */
static void spread(bits *mask)
{
    uint64_t last = bits_last_word(mask);
    for (int row = 0; row < mask->rows; row++) {
        uint64_t *words = bits_row(mask, row), before = 0;
        for (int k = 0; k < mask->width; k++) {
            uint64_t own = words[k], after = k + 1 < mask->width ? words[k + 1] : 0;
            words[k] = own | own << 1 | before >> 63 | own >> 1 | after << 63;
            before = own;
        }
        words[mask->width - 1] &= last;
    }
}

int bits_dilated(const bits *mask, bits *out, int radius, const int32_t *half)
{
    bits wide = bits_new(mask->rows, mask->columns);
    *out = bits_new(mask->rows, mask->columns);
    if (!wide.words || !out->words) {
        free(wide.words);
        return 0;
    }
    memcpy(wide.words, mask->words, (size_t)mask->rows * (size_t)mask->width * sizeof(uint64_t));
    int most = half ? 0 : radius;
    for (int dy = 0; half && dy <= radius; dy++)
        most = half[dy] > most ? half[dy] : most;
    for (int reach = 0; reach <= most; reach++) { /* all rows of the disc that are so wide, together */
        for (int dy = -radius; dy <= radius; dy++) {
            if ((half ? half[dy < 0 ? -dy : dy] : radius) != reach)
                continue;
            int first = dy > 0 ? dy : 0, stop = dy > 0 ? mask->rows : mask->rows + dy;
            uint64_t *to = out->words;
            for (int64_t k = (int64_t)first * mask->width; k < (int64_t)stop * mask->width; k++)
                to[k] |= wide.words[k - (int64_t)dy * mask->width];
        }
        if (reach < most)
            spread(&wide);
    }
    free(wide.words);
    return 1;
}

void bits_turn_over(bits *mask)
{
    uint64_t last = bits_last_word(mask);
    for (int row = 0; row < mask->rows; row++) {
        uint64_t *words = bits_row(mask, row);
        for (int k = 0; k < mask->width; k++)
            words[k] = ~words[k];
        words[mask->width - 1] &= last;
    }
}

int bits_eroded(const bits *mask, bits *out, int radius, const int32_t *half)
{
    bits other = bits_new(mask->rows, mask->columns);
    if (!other.words)
        return 0;
    memcpy(other.words, mask->words, (size_t)mask->rows * (size_t)mask->width * sizeof(uint64_t));
    bits_turn_over(&other);
    int done = bits_dilated(&other, out, radius, half);
    free(other.words);
    if (done)
        bits_turn_over(out);
    return done;
}

void bits_placed(const bits *from, bits *out, int down, int right)
{
    uint64_t last = bits_last_word(out);
    int step = right >= 0 ? right >> 6 : -((-right + 63) >> 6), shift = right - 64 * step;
    for (int row = 0; row < from->rows; row++) {
        if (row + down < 0 || row + down >= out->rows)
            continue;
        const uint64_t *words = bits_row(from, row);
        uint64_t *to = bits_row(out, row + down);
        for (int k = 0; k < from->width; k++) {
            int at = k + step;
            if (at >= 0 && at < out->width)
                to[at] |= words[k] << shift;
            if (shift && at + 1 >= 0 && at + 1 < out->width)
                to[at + 1] |= words[k] >> (64 - shift);
        }
        to[out->width - 1] &= last;
    }
}
