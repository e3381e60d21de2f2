/* The Gauss-Newton system of points that slide along their sections' curves: what geometry/correspondence.py sets
 * up for all points at once. */
#include <math.h>

#include "pixels.h"

typedef struct {
    int64_t rings, round;
    const double *point[2], *slope[2], *current, *first, *spacing, *pair, *own;
    double evenness, hold;
} slide;

typedef struct {
    double *diagonal, *along, *across, *right;
} rings_system;

/* What holds a section's points apart: unevenness, and a pull to the first guess. */
INLINE void spaced(const slide *of, int64_t ring, const rings_system *to)
{
    int64_t n = of->round, at = ring * n;
    const double *restrict current = of->current + at, *restrict first = of->first + at;
    const double *restrict spacing = of->spacing + at;
    double *restrict diagonal = to->diagonal + at, *restrict along = to->along + at;
    double *restrict right = to->right + at, *restrict stretch = to->across + at; /* not needed yet */
    double own = of->own[ring], evenness = of->evenness, hold = of->hold;
    for (int64_t j = 0; j < n; j++) {
        double gap = current[j + 1 < n ? j + 1 : 0] - current[j], share = own / (spacing[j] * spacing[j]);
        along[j] = -evenness * share;
        stretch[j] = evenness * share * (gap - floor(gap) - spacing[j]);
        diagonal[j] = hold * share - along[j];
        right[j] = hold * share * (current[j] - first[j]) - stretch[j];
    }
    for (int64_t j = 0; j < n; j++) {
        diagonal[j] -= along[j ? j - 1 : n - 1];
        right[j] += stretch[j ? j - 1 : n - 1];
    }
}

/* What holds a column together between a section and the next: Q[i+1] - Q[i]. */
INLINE void joined(const slide *of, int64_t ring, const rings_system *to)
{
    int64_t n = of->round;
    double pair = of->pair[ring];
    const double *x = of->point[0], *y = of->point[1], *dx = of->slope[0], *dy = of->slope[1];
    for (int64_t j = ring * n, k = j + n; j < (ring + 1) * n; j++, k++) {
        double right = x[k] - x[j], up = y[k] - y[j];
        to->diagonal[j] += pair * (dx[j] * dx[j] + dy[j] * dy[j]);
        to->diagonal[k] += pair * (dx[k] * dx[k] + dy[k] * dy[k]);
        to->right[j] -= pair * (right * dx[j] + up * dy[j]);
        to->right[k] += pair * (right * dx[k] + up * dy[k]);
        to->across[j] = -pair * (dx[k] * dx[j] + dy[k] * dy[j]);
    }
}

TUNED static void set_up(const slide *of, const rings_system *to)
{
    for (int64_t ring = 0; ring < of->rings; ring++)
        spaced(of, ring, to);
    for (int64_t ring = 0; ring + 1 < of->rings; ring++)
        joined(of, ring, to);
    for (int64_t j = (of->rings - 1) * of->round; j < of->rings * of->round; j++)
        to->across[j] = 0.0;
}

/* Set the system up that stackloft_solve_rings solves.
 *
 * from    points (x, y), slopes (x, y), current and first fractions, spacing; of pairs of sections the weight, of
 *         each section its own
 * costs   of unevenness, and of leaving the first guess
 * fixed   points that stay, by coefficients of `huge` times the largest
 * to      room for the diagonal, the coefficients along and across, and the right side
 */
EXPORT void stackloft_slide_system(int64_t rings, int64_t round, const double *const *from, const double *costs,
                                   const uint8_t *fixed, double huge, double *const *to)
{
    slide of = {rings, round, {from[0], from[1]}, {from[2], from[3]}, from[4], from[5], from[6], from[7], from[8],
                costs[0], costs[1]};
    rings_system found = {to[0], to[1], to[2], to[3]};
    set_up(&of, &found);
    double largest = 0.0;
    for (int64_t j = 0; j < rings * round; j++)
        largest = fmax(largest, found.diagonal[j]);
    for (int64_t j = 0; j < rings * round; j++)
        if (fixed[j]) {
            found.diagonal[j] += huge * largest;
            found.right[j] = 0.0;
        }
}
