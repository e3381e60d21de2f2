/* Length, area, centroid and first Fourier coefficient of closed piecewise cubics, by Gauss, loop after loop:
 * what geometry/curve_measures.py does for many at once. */
#include <math.h>
#include <stdlib.h>

#include "cubic.h"

enum { MOST = 4, FIGURES = 7 };

typedef struct {
    int64_t count; /* Gauss points of a segment */
    const double *places, *weights;
} rule;

typedef struct {
    int64_t entries; /* of a turn */
    const double *cosines, *sines;
} turn_table;

typedef struct {
    double *x[MOST], *y[MOST], *speed[MOST]; /* of each Gauss point, all segments */
    double *along, *up, *cross, *segment;
} room;

/* Four sums: in one, each addend would wait for the last. */
INLINE double sum_of(const double *values, int64_t count)
{
    double lanes[4] = {0.0, 0.0, 0.0, 0.0};
    int64_t whole = count / 4 * 4;
    for (int64_t i = 0; i < whole; i += 4)
        for (int lane = 0; lane < 4; lane++)
            lanes[lane] += values[i + lane];
    for (int64_t i = whole; i < count; i++)
        lanes[i - whole] += values[i];
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

INLINE double product_of(const double *a, const double *b, int64_t count)
{
    double lanes[4] = {0.0, 0.0, 0.0, 0.0};
    int64_t whole = count / 4 * 4;
    for (int64_t i = 0; i < whole; i += 4)
        for (int lane = 0; lane < 4; lane++)
            lanes[lane] += a[i + lane] * b[i + lane];
    for (int64_t i = whole; i < count; i++)
        lanes[i - whole] += a[i] * b[i];
    return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
}

/* One coordinate, from the loop's first vertex, and its slope at one Gauss point of all segments. */
INLINE void coordinate(const double *restrict p0, const double *restrict p1, const double *restrict d0,
                       const double *restrict d1, double t, int64_t count, double *restrict point,
                       double *restrict along)
{
    double begin = p0[0];
    for (int64_t i = 0; i < count; i++) {
        on_cubic at = along_cubic(p0[i], p1[i], d0[i], d1[i], t);
        point[i] = at.point - begin;
        along[i] = at.along;
    }
}

INLINE void weigh(const double *restrict x, const double *restrict y, const double *restrict along,
                  const double *restrict up, double weight, int64_t count, double *restrict cross,
                  double *restrict speed, double *restrict segment)
{
    for (int64_t i = 0; i < count; i++) {
        cross[i] = weight * (x[i] * up[i] - y[i] * along[i]);
        speed[i] = weight * sqrt(along[i] * along[i] + up[i] * up[i]);
        segment[i] += speed[i];
    }
}

/* Twice the area of the polygon. */
INLINE double shoelace(const double *x0, const double *y0, const double *x1, const double *y1, int64_t count,
                       double *restrict cross)
{
    double x = x0[0], y = y0[0];
    for (int64_t i = 0; i < count; i++)
        cross[i] = (x0[i] - x) * (y1[i] - y) - (y0[i] - y) * (x1[i] - x);
    return sum_of(cross, count);
}

/* The Fourier coefficient's addends of one Gauss point, cosine and sine as in geometry/turn_table.py. */
INLINE void turned(const turn_table *by, const double *restrict x, const double *restrict y,
                   const double *restrict speed, const double *restrict fraction, const double *restrict segment,
                   double t, const double centre[2], int64_t count, double *restrict real,
                   double *restrict imaginary)
{
    const double *restrict cosines = by->cosines, *restrict sines = by->sines;
    double entries = (double)by->entries, angle = 6.283185307179586 / entries, cx = centre[0], cy = centre[1];
    for (int64_t i = 0; i < count; i++) {
        double rest = (fraction[i] + t * segment[i]) * entries;
        rest = rest >= 0.0 && rest <= entries ? rest : 0.0; /* of a loop without length */
        double nearest = nearbyint(rest);
        int32_t entry = (int32_t)nearest;
        rest = (rest - nearest) * angle;
        double square = rest * rest, near = (square * (1.0 / 24.0) - 0.5) * square + 1.0;
        rest *= square * (1.0 / 120.0 * square - 1.0 / 6.0) + 1.0;
        double cosine = cosines[entry] * near - sines[entry] * rest;
        double sine = sines[entry] * near + cosines[entry] * rest, right = x[i] - cx, up = y[i] - cy;
        real[i] = speed[i] * (right * cosine + up * sine);
        imaginary[i] = speed[i] * (up * cosine - right * sine);
    }
}

/* Of one loop: length, area, the polygon's, centroid from the first vertex, Fourier coefficient. */
TUNED static void measure(const double *const from[8], int64_t count, const rule *gauss, const turn_table *table,
                          const room *in, double *fraction, double figures[FIGURES])
{
    double area = 0.0, arm[2] = {0.0, 0.0}, real = 0.0, imaginary = 0.0, before = 0.0;
    for (int64_t i = 0; i < count; i++)
        in->segment[i] = 0.0;
    for (int64_t k = 0; k < gauss->count; k++) {
        double t = gauss->places[k];
        coordinate(from[0], from[2], from[4], from[6], t, count, in->x[k], in->along);
        coordinate(from[1], from[3], from[5], from[7], t, count, in->y[k], in->up);
        weigh(in->x[k], in->y[k], in->along, in->up, gauss->weights[k], count, in->cross, in->speed[k], in->segment);
        area += 0.5 * sum_of(in->cross, count);
        arm[0] += product_of(in->cross, in->x[k], count);
        arm[1] += product_of(in->cross, in->y[k], count);
    }
    for (int axis = 0; axis < 2; axis++)
        arm[axis] /= 3.0 * area;
    for (int64_t i = 0; i < count; i++) {
        fraction[i] = before;
        before += in->segment[i];
    }
    double share = 1.0 / before;
    for (int64_t i = 0; i < count; i++) {
        fraction[i] *= share;
        in->segment[i] *= share;
    }
    for (int64_t k = 0; k < gauss->count; k++) {
        turned(table, in->x[k], in->y[k], in->speed[k], fraction, in->segment, gauss->places[k], arm, count, in->along,
               in->up);
        real += sum_of(in->along, count);
        imaginary += sum_of(in->up, count);
    }
    double polygon = 0.5 * shoelace(from[0], from[1], from[2], from[3], count, in->cross);
    double found[FIGURES] = {before, area, polygon, arm[0], arm[1], real, imaginary};
    for (int k = 0; k < FIGURES; k++)
        figures[k] = found[k];
}

/* Measure closed loops of cubic segments.
 *
 * loops      their number; `first`: segment of each, and the end of the last
 * from       x and y of the segments' starts, ends, leaving and arriving slopes
 * gauss      at most four points from 0 to 1, and their weights
 * table      cosines and sines of all entries' multiples of a turn, the whole turn too
 * fractions  room for each segment's start; `figures`: for seven figures of each loop, see `measure`
 *
 * Returns 1; 0 when memory is short.
 */
EXPORT int stackloft_curve_figures(int64_t loops, const int64_t *first, const double *const *from, int64_t points,
                                   const double *const *gauss, int64_t entries, const double *const *table,
                                   double *fractions, double *figures)
{
    int64_t longest = 0;
    for (int64_t k = 0; k < loops; k++)
        longest = first[k + 1] - first[k] > longest ? first[k + 1] - first[k] : longest;
    double *all = points > MOST ? NULL : malloc((3 * MOST + 4) * sizeof(double) * (size_t)longest);
    if (!all)
        return 0;
    room in = {.along = all, .up = all + longest, .cross = all + 2 * longest, .segment = all + 3 * longest};
    for (int64_t k = 0; k < MOST; k++) {
        in.x[k] = all + (4 + 3 * k) * longest;
        in.y[k] = in.x[k] + longest, in.speed[k] = in.y[k] + longest;
    }
    rule by = {points, gauss[0], gauss[1]};
    turn_table turns = {entries, table[0], table[1]};
    for (int64_t k = 0; k < loops; k++) {
        const double *own[8];
        for (int part = 0; part < 8; part++)
            own[part] = from[part] + first[k];
        measure(own, first[k + 1] - first[k], &by, &turns, &in, fractions + first[k], figures + FIGURES * k);
    }
    free(all);
    return 1;
}
