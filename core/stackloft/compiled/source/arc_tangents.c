/* Tangents of closed loops' cubic splines, arc after arc: what geometry/hermite_segments.py and
 * geometry/arc_splines.py do for many arcs at once. */
#include <math.h>
#include <stdlib.h>

#include "pixels.h"

enum { STENCIL = 4 };

typedef struct {
    int64_t loop, begin, nodes, lead; /* `lead`: segments at either end that only lead in or out */
} arc;

typedef struct {
    double *x, *y, *chord, *steep, *over, *right[2];
} room;

/* Lay an arc's vertices out, with what lies between them. */
INLINE void lay_out(const arc *of, int64_t count, const double *const planes[2], const room *to)
{
    int64_t vertex = of->begin % count;
    vertex += vertex < 0 ? count : 0;
    for (int64_t i = 0; i < of->nodes; i++) {
        to->x[i] = planes[0][vertex];
        to->y[i] = planes[1][vertex];
        vertex = vertex + 1 < count ? vertex + 1 : 0;
    }
    const double *restrict x = to->x, *restrict y = to->y;
    double *restrict chord = to->chord, *restrict steep = to->steep;
    for (int64_t i = 0; i < of->nodes - 1; i++) {
        double right = x[i + 1] - x[i], up = y[i + 1] - y[i];
        chord[i] = sqrt(right * right + up * up);
        steep[i] = 1.0 / (chord[i] > 1e-300 ? chord[i] : 1e-300);
    }
}

/* At an arc's first or last node, the derivative of the polynomial through its nearest points, at most four. */
static void end_tangent(const room *of, int64_t nodes, int64_t step, double tangent[2])
{
    int64_t end = step > 0 ? 0 : nodes - 1, count = nodes < STENCIL ? nodes : STENCIL;
    double t[STENCIL] = {0.0};
    for (int64_t j = 1; j < count; j++) {
        double chord = of->chord[step > 0 ? j - 1 : nodes - 1 - j];
        t[j] = t[j - 1] + (double)step * (chord > 1e-300 ? chord : 1e-300);
    }
    tangent[0] = tangent[1] = 0.0;
    for (int64_t j = 1; j < count; j++) {
        double weight = 1.0 / t[j];
        for (int64_t i = 1; i < count; i++)
            if (i != j)
                weight *= t[i] / (t[i] - t[j]);
        tangent[0] += weight * (of->x[end + step * j] - of->x[end]);
        tangent[1] += weight * (of->y[end + step * j] - of->y[end]);
    }
}

/* Solve for the tangents at the nodes in between; `right` has the ends' on entry and all of them on return. */
INLINE void solve(const room *of, int64_t nodes)
{
    const double *steep = of->steep;
    double *x = of->right[0], *y = of->right[1], over = 0.0;
    for (int64_t i = 1; i < nodes - 1; i++) {
        double before = steep[i - 1], after = steep[i];
        double inverse = 1.0 / (2.0 * (before + after) - before * over);
        double back = 3.0 * before * before, ahead = 3.0 * after * after;
        double right = back * (of->x[i] - of->x[i - 1]) + ahead * (of->x[i + 1] - of->x[i]);
        double up = back * (of->y[i] - of->y[i - 1]) + ahead * (of->y[i + 1] - of->y[i]);
        x[i] = (right - before * x[i - 1]) * inverse;
        y[i] = (up - before * y[i - 1]) * inverse;
        of->over[i] = over = after * inverse;
    }
    for (int64_t i = nodes - 2; i > 0; i--) {
        x[i] -= of->over[i] * x[i + 1];
        y[i] -= of->over[i] * y[i + 1];
    }
}

TUNED static void fit(const arc *of, int64_t count, const double *const planes[2], const room *in,
                      double *const slopes[4])
{
    lay_out(of, count, planes, in);
    double ends[2][2];
    end_tangent(in, of->nodes, 1, ends[0]);
    end_tangent(in, of->nodes, -1, ends[1]);
    for (int axis = 0; axis < 2; axis++)
        in->right[axis][0] = ends[0][axis], in->right[axis][of->nodes - 1] = ends[1][axis];
    solve(in, of->nodes);
    int64_t vertex = (of->begin + of->lead) % count;
    for (int64_t i = of->lead; i < of->nodes - 1 - of->lead; i++) {
        for (int axis = 0; axis < 2; axis++) {
            slopes[axis][vertex] = in->right[axis][i] * in->chord[i];
            slopes[2 + axis][vertex] = in->right[axis][i + 1] * in->chord[i];
        }
        vertex = vertex + 1 < count ? vertex + 1 : 0;
    }
}

/* Find the slopes of all loops' segments at their starts and ends.
 *
 * arcs    loop, first vertex, nodes and lead of each, see geometry/hermite_segments.py
 * first   vertex of each loop, and the end of the last
 * planes  x and y of the vertices
 * slopes  room for dx and dy at the segments' starts and at their ends
 *
 * Returns 1; 0 when memory is short.
 */
EXPORT int stackloft_arc_tangents(int64_t count, const arc *arcs, const int64_t *first, const double *const *planes,
                                  double *const *slopes)
{
    int64_t longest = 0;
    for (int64_t k = 0; k < count; k++)
        longest = arcs[k].nodes > longest ? arcs[k].nodes : longest;
    double *all = malloc(7 * sizeof(double) * (size_t)longest);
    if (!all)
        return 0;
    double *part[7];
    for (int k = 0; k < 7; k++)
        part[k] = all + k * longest;
    room in = {part[0], part[1], part[2], part[3], part[4], {part[5], part[6]}};
    for (int64_t k = 0; k < count; k++) {
        int64_t begin = first[arcs[k].loop], length = first[arcs[k].loop + 1] - begin;
        const double *const own[2] = {planes[0] + begin, planes[1] + begin};
        double *const to[4] = {slopes[0] + begin, slopes[1] + begin, slopes[2] + begin, slopes[3] + begin};
        fit(arcs + k, length, own, &in, to);
    }
    free(all);
    return 1;
}
