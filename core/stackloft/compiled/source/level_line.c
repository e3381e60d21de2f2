/* The closed line around a chain of border pixels, put where the field equals its level: what
 * sectioning/border_chains.py and sectioning/sub_pixel.py do, one line at a time (their texts say why). */
#include <math.h>
#include <stdlib.h>

#include "pixels.h"
#include "threads.h"

enum { REACH = 2, FEWEST = 16, NEWTON_STEPS = 4 };
#define BEYOND 0.25
#define DOMINANCE 0.8
#define NEARLY_OFF 0.15
#define OFF 0.25
#define BLURRED 0.46
#define SHARP 0.54

typedef struct {
    int32_t row, column; /* the pixel that the crossed edge starts from */
    int32_t down;        /* 1: the edge runs to the pixel below; 0: to the one on the right */
    int32_t across;      /* whether it runs across the boundary rather than along it */
    double sample[4];    /* the field above its level, along the edge, from one pixel before it on */
    double fraction;     /* of the edge, where the boundary crosses it */
} crossing;

static const int WAY[3][3] = {{3, 2, 1}, {4, -1, 0}, {5, 6, 7}}; /* by 1 + row step, 1 + column step */

static int way_between(const int32_t *from, const int32_t *to)
{
    return WAY[1 + to[1] - from[1]][1 + to[0] - from[0]];
}

static void add(crossing *to, const int32_t *pixel, int way)
{
    to->down = way == 2 || way == 6;
    to->column = pixel[0] - (way == 4);
    to->row = pixel[1] - (way == 2);
}

/* List the edges between border pixels and their outer neighbours, backwards, so that the body is on the left. */
static int64_t crossings_of(const int32_t *chain, int64_t length, crossing *list, int64_t most)
{
    int64_t count = 0;
    for (int64_t k = 0; k < length; k++) {
        const int32_t *here = chain + 2 * k;
        int back = 7, turns = 8; /* of a single pixel: all four sides, from the right one on */
        if (length > 1) {
            back = way_between(here, chain + 2 * (k ? k - 1 : length - 1));
            turns = (way_between(here, chain + 2 * (k + 1 < length ? k + 1 : 0)) - back + 7) & 7;
        }
        for (int turn = 1; turn <= turns; turn++) {
            int way = (back + turn) & 7;
            if (way & 1)
                continue;
            if (count == most)
                return -1;
            add(list + count++, here, way);
        }
    }
    for (int64_t a = 0, b = count - 1; a < b; a++, b--) {
        crossing kept = list[a];
        list[a] = list[b], list[b] = kept;
    }
    return count;
}

/* Take the samples along an edge, and see whether the field changes faster along it than across: slopes of
 * the plane fitted to the 4 × 3 pixels around it. */
INLINE void look(int kind, crossing *one, const pixels *picture, double level)
{
    double along[4], across[3] = {0.0, 0.0, 0.0};
    for (int step = 0; step < 4; step++) {
        double cell[3];
        for (int side = 0; side < 3; side++) {
            int row = one->row + (one->down ? step : side) - 1, column = one->column + (one->down ? side : step) - 1;
            cell[side] = grey_as(kind, picture, row, column);
            across[side] += cell[side];
        }
        along[step] = cell[0] + cell[1] + cell[2];
        one->sample[step] = cell[1] - level;
    }
    double slope = fabs(3.0 * (along[3] - along[0]) + (along[2] - along[1]));
    one->across = 8.0 * slope >= 30 * DOMINANCE * fabs(across[2] - across[0]);
    one->fraction = one->sample[1] / (one->sample[1] - one->sample[2]);
}

INLINE void look_at_all(int kind, crossing *list, int64_t count, const pixels *picture, double level)
{
    for (int64_t k = 0; k < count; k++)
        look(kind, list + k, picture, level);
}

static int is_clean(const crossing *one)
{
    return one->sample[0] * one->sample[1] > 0.0 && one->sample[2] * one->sample[3] > 0.0;
}

static double ramp(double value, double low, double high)
{
    double part = (value - low) / (high - low);
    return part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
}

/* Return where the cubic through four samples is zero, between the middle two (Newton's method). */
static double cubic_crossing(const double *s, double t)
{
    double linear = -s[0] / 3 - s[1] / 2 + s[2] - s[3] / 6, square = s[0] / 2 - s[1] + s[2] / 2;
    double cube = (s[1] - s[2]) / 2 + (s[3] - s[0]) / 6;
    for (int step = 0; step < NEWTON_STEPS; step++) {
        double slope = linear + t * (2 * square + 3 * t * cube);
        double value = s[1] + t * (linear + t * (square + t * cube));
        t -= slope != 0.0 ? value / slope : 0.0;
        t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    }
    return t;
}

static void refine(crossing *one, double sharp)
{
    const double *s = one->sample;
    double rise = s[0] - s[3], means = (s[0] + s[1] + s[2]) / rise;
    double off_middle = fabs(s[0] + s[3]) / (2.0 * fabs(rise));
    double share = sharp * ramp(-off_middle, -OFF, -NEARLY_OFF);
    if (means < -BEYOND || means > 1 + BEYOND)
        share = 0.0;
    if (share < 1.0) {
        double cubic = cubic_crossing(s, one->fraction);
        means = share > 0.0 ? share * means + (1 - share) * cubic : cubic;
    }
    one->fraction = means;
}

/* Put the crossings on the level; return how many run across the boundary. */
static int64_t placed(crossing *list, int64_t count, const pixels *picture, double level)
{
    double between = 0.0, whole = 0.0;
    int64_t across = 0;
#define LOOK(KIND) look_at_all(KIND, list, count, picture, level)
    FOR_KIND(picture->kind, LOOK)
    for (int64_t k = 0; k < count; k++) {
        crossing *one = list + k;
        one->across = one->across && count >= FEWEST;
        across += one->across;
        if (is_clean(one)) {
            between += fabs(one->sample[1] - one->sample[2]);
            whole += fabs(one->sample[0] - one->sample[3]);
        }
    }
    double sharp = ramp(whole > 0.0 ? between / whole : 0.0, BLURRED, SHARP);
    for (int64_t k = 0; k < count; k++)
        if (list[k].across && is_clean(list + k))
            refine(list + k, sharp);
    return across;
}

/* Return twice the area of the polygon of the edges' middles, in pixels. */
static double twice_area(const crossing *list, int64_t count)
{
    double twice = 0.0, x0 = list[0].column + 0.5 * !list[0].down, y0 = list[0].row + 0.5 * list[0].down;
    double x = 0.0, y = 0.0;
    for (int64_t k = 1; k < count; k++) {
        double next_x = list[k].column + 0.5 * !list[k].down - x0, next_y = list[k].row + 0.5 * list[k].down - y0;
        twice += x * next_y - y * next_x;
        x = next_x, y = next_y;
    }
    return twice;
}

static int near_border(const int32_t *chain, int64_t length, const pixels *picture)
{
    for (int64_t k = 0; k < length; k++) {
        int32_t x = chain[2 * k], y = chain[2 * k + 1];
        if (x < REACH || y < REACH || x >= picture->columns - REACH || y >= picture->rows - REACH)
            return 1;
    }
    return 0;
}

/* Write the points in mm without those that repeat the one before; return how many. */
static int64_t written(const crossing *list, int64_t count, int all, const int32_t *first, const double *spacing,
                       double *points)
{
    int64_t length = 0;
    for (int64_t k = 0; k < count; k++) {
        const crossing *one = list + k;
        if (!all && !one->across)
            continue;
        points[2 * length] = (one->column + (one->down ? 0.0 : one->fraction) + first[1]) * spacing[1];
        points[2 * length + 1] = (one->row + (one->down ? one->fraction : 0.0) + first[0]) * spacing[0];
        length++;
    }
    double least = 1e-9 * fmax(spacing[0], spacing[1]);
    int64_t kept = 0;
    double x = points[2 * length - 2], y = points[2 * length - 1];
    for (int64_t k = 0; k < length; k++) {
        double to_x = points[2 * k], to_y = points[2 * k + 1];
        if (fmax(fabs(to_x - x), fabs(to_y - y)) > least) {
            points[2 * kept] = to_x, points[2 * kept + 1] = to_y;
            kept++;
        }
        x = to_x, y = to_y;
    }
    return kept;
}

typedef struct {
    pixels picture;
    double level;
    const int32_t *chain; /* border pixels (column, row) as numbered in the picture */
    int64_t length;
    int32_t first[2];  /* row and column of the picture's first pixel in the slice */
    double spacing[2]; /* mm from row to row and from column to column */
    double *points;    /* room for `capacity` points (x, y), mm */
    int64_t capacity;
    int64_t count; /* out: points; -1 where the body is too near the border, or room or memory is short */
    double area;   /* out: the outline's rough area, pixels² */
} line_job;

/* Trace the one outline of a slice. */
static void trace(void *jobs, int64_t number)
{
    line_job *job = (line_job *)jobs + number;
    job->count = -1;
    if (near_border(job->chain, job->length, &job->picture))
        return;
    crossing *list = malloc((size_t)job->capacity * sizeof(crossing));
    int64_t count = list ? crossings_of(job->chain, job->length, list, job->capacity) : -1;
    if (count > 0) {
        job->area = 0.5 * twice_area(list, count);
        int64_t across = placed(list, count, &job->picture, job->level);
        count = written(list, count, across < FEWEST / 2, job->first, job->spacing, job->points);
    }
    job->count = count;
    free(list);
}

EXPORT void stackloft_level_lines(line_job *jobs, int64_t count, int threads)
{
    for_each(trace, jobs, count, threads);
}
