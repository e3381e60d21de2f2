/* What a slice adds to a body's volume by partly filled pixels: counts and sums over the zone about its edge
 * (integrators/partial_volume.py says what they are for). */
#include <stdlib.h>
#include <string.h>

#include "gather.h"
#include "threads.h"

typedef struct {
    uint64_t *words; /* a mask's, as bits.h has them; NULL: there is no such slice */
    int32_t rows, columns;
    int64_t down, right; /* from the current picture's first pixel to its own */
} beside;

typedef struct {
    double *values; /* room for `room` values of the ring inside, then as much for the one outside */
    int64_t room;
    int64_t counts[2]; /* out */
    int32_t reach; /* pixels, of every `step`-th pixel alone */
    int32_t step;
} rings;

/* Narrow `common` to what the slice beside shows too, and widen `united` by it. */
static int take_beside(const beside *other, bits *common, bits *united)
{
    int64_t words = (int64_t)common->rows * common->width;
    if (!other->words) {
        memset(common->words, 0, (size_t)words * sizeof(uint64_t));
        return 1;
    }
    bits shown = {other->words, other->rows, other->columns, (other->columns + 63) / 64};
    bits here = bits_new(common->rows, common->columns);
    if (here.words) {
        bits_placed(&shown, &here, (int)other->down, (int)other->right);
        for (int64_t k = 0; k < words; k++) {
            common->words[k] &= here.words[k];
            united->words[k] |= here.words[k];
        }
    }
    int done = here.words != NULL;
    free(here.words);
    return done;
}

INLINE void sum_up(int kind, const pixels *picture, double level, const bits *common, const bits *inside, const bits *near,
                   double *sums)
{
    double edge = 0.0, all = 0.0, full = 0.0, full_grey = 0.0;
    for (int row = 0; row < near->rows; row++)
        for (int k = 0; k < near->width; k++) {
            int64_t at = (int64_t)row * near->width + k;
            uint64_t between = near->words[at] ^ inside->words[at], filled = common->words[at];
            for (; between; between &= between - 1) {
                int bit = __builtin_ctzll(between);
                double value = grey_as(kind, picture, row, 64 * k + bit) - level;
                edge += 1.0, all += value;
                if (filled >> bit & 1)
                    full += 1.0, full_grey += value;
            }
        }
    sums[0] = (double)bits_count(inside);
    sums[1] = edge, sums[2] = all, sums[3] = full, sums[4] = full_grey;
}

/* Gather every other bit into the lower half. */
static uint64_t every_other(uint64_t word)
{
    static const uint64_t kept[] = {UINT64_C(0x5555555555555555), UINT64_C(0x3333333333333333),
                                    UINT64_C(0x0f0f0f0f0f0f0f0f), UINT64_C(0x00ff00ff00ff00ff),
                                    UINT64_C(0x0000ffff0000ffff), UINT64_C(0x00000000ffffffff)};
    word &= kept[0];
    for (int k = 1; k < 6; k++)
        word = (word | word >> (1 << (k - 1))) & kept[k];
    return word;
}

/* Return the mask, or every other pixel of every other row (`step` 2). */
static bits every(const bits *mask, int step)
{
    bits few = bits_new((mask->rows + step - 1) / step, (mask->columns + step - 1) / step);
    for (int row = 0; few.words && row < few.rows; row++) {
        const uint64_t *from = bits_row(mask, row * step);
        uint64_t *to = bits_row(&few, row);
        for (int k = 0; k < mask->width; k++) {
            if (step == 1)
                to[k] = from[k];
            else
                to[k / 2] |= every_other(from[k]) << (k & 1 ? 32 : 0);
        }
    }
    return few;
}

/* Take the field in the rings on either side of the edge zone, `reach` pixels wide in squares. */
static int take_rings(const pixels *picture, double level, const bits *inside, const bits *near, rings *to)
{
    bits few[2] = {every(inside, to->step), every(near, to->step)}, other[2] = {{0}, {0}};
    int done = few[0].words && few[1].words && (to->step == 1 || to->step == 2) &&
               bits_eroded(few, other, to->reach, NULL) && bits_dilated(few + 1, other + 1, to->reach, NULL);
    for (int k = 0; done && k < 2; k++) {
        double *values = to->values + k * to->room;
        to->counts[k] = gathered(picture->kind, picture, level, few + k, other + k, to->step, values, to->room);
        done = to->counts[k] >= 0;
    }
    for (int k = 0; k < 2; k++)
        free(few[k].words), free(other[k].words);
    return done;
}

typedef struct {
    pixels picture;
    double level;
    uint64_t *words; /* rows · ⌈columns / 64⌉: the body's mask */
    int32_t done;    /* out: 0 when memory is short */
} mask_job;

static void mask(void *jobs, int64_t number)
{
    mask_job *job = (mask_job *)jobs + number;
    bits found = bits_above(&job->picture, job->level);
    job->done = found.words != NULL;
    if (found.words)
        memcpy(job->words, found.words, (size_t)found.rows * (size_t)found.width * sizeof(uint64_t));
    free(found.words);
}

EXPORT void stackloft_masks(mask_job *jobs, int64_t count, int threads)
{
    for_each(mask, jobs, count, threads);
}

typedef struct {
    pixels picture;
    double level;
    const uint64_t *words; /* the picture's mask */
    beside others[2];      /* the slices before and after */
    const int32_t *half;   /* reach of each row of the disc by which the zone is wide, from the middle one outwards */
    int32_t radius;
    int32_t done;   /* out: 0 when memory or room is short */
    double sums[5]; /* out: pixels inside, in the edge zone, the zone's field, its pixels at most full, their field */
    rings ring;     /* what is wanted of the rings beside the zone; without values: nothing */
} cover_job;

static void cover(void *jobs, int64_t number)
{
    cover_job *job = (cover_job *)jobs + number;
    const pixels *picture = &job->picture;
    bits common = bits_new(picture->rows, picture->columns), united = bits_new(picture->rows, picture->columns);
    bits inside = {0}, near = {0};
    int done = common.words && united.words;
    if (done) {
        size_t size = (size_t)common.rows * (size_t)common.width * sizeof(uint64_t);
        memcpy(common.words, job->words, size);
        memcpy(united.words, job->words, size);
        done = take_beside(job->others, &common, &united) && take_beside(job->others + 1, &common, &united) &&
               bits_eroded(&common, &inside, job->radius, job->half) &&
               bits_dilated(&united, &near, job->radius, job->half);
    }
    if (done) {
#define SUM_UP(KIND) sum_up(KIND, picture, job->level, &common, &inside, &near, job->sums)
        FOR_KIND(picture->kind, SUM_UP)
        done = !job->ring.values || take_rings(picture, job->level, &inside, &near, &job->ring);
    }
    job->done = done;
    free(common.words), free(united.words), free(inside.words), free(near.words);
}

EXPORT void stackloft_coverage(cover_job *jobs, int64_t count, int threads)
{
    for_each(cover, jobs, count, threads);
}
