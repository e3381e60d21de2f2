/* A chain of rings of unknowns: each unknown is coupled to its neighbours round its ring and to the one at the
 * same place in the next ring. The matrix is banded; Cholesky's factors L D Lᵀ of it, four columns (a panel) at
 * a time.
 *
 *      panel of columns j … j+3, each kept from row j on, so that all four begin and end together
 *      j   |\            what is above the diagonal is never read
 *          | \
 *          |  |          width = the next multiple of four from n + 4 on: rows j … j + width - 1
 *          |__|
 */
#include <stdlib.h>
#include <string.h>

#include "pixels.h"

enum { COLUMNS = 4 };

/* Four rows of a column. Panels are whole numbers of these; compilers take loops of such few rounds apart badly. */
typedef double four __attribute__((vector_size(4 * sizeof(double)), aligned(sizeof(double)), may_alias));

typedef struct {
    int64_t size, round, width;                 /* unknowns, those of a ring, rows of a panel */
    const double *diagonal, *along, *across;
} chain;

/* Write a panel's columns of the matrix; beyond its last column stand ones. */
static void fill(const chain *of, int64_t first, double *panel)
{
    memset(panel, 0, sizeof(double) * (size_t)(COLUMNS * of->width));
    for (int64_t p = 0; p < COLUMNS; p++) {
        int64_t column = first + p, place = column % of->round;
        double *at = panel + p * of->width + p;
        if (column >= of->size) {
            at[0] = 1.0;
            continue;
        }
        at[0] = of->diagonal[column];
        if (place + 1 < of->round)
            at[1] = of->along[column];
        if (place == 0)
            at[of->round - 1] = of->along[column + of->round - 1];
        at[of->round] = of->across[column];
    }
}

/* Factor a panel that all columns before it are taken from; returns whether its pivots are positive. */
INLINE int factor(double *panel, int64_t width, double pivot[COLUMNS])
{
    int positive = 1;
    for (int p = 0; p < COLUMNS; p++) {
        double *own = panel + p * width, next[COLUMNS];
        pivot[p] = own[p];
        positive &= own[p] > 0.0;
        double inverse = 1.0 / own[p];
        for (int k = p + 1; k < COLUMNS; k++)
            next[k] = own[k];
        for (int64_t row = 0; row < width; row++)
            own[row] *= inverse;
        for (int k = p + 1; k < COLUMNS; k++) {
            double *restrict to = panel + k * width, by = next[k];
            for (int64_t row = 0; row < width; row++)
                to[row] -= by * own[row];
        }
    }
    return positive;
}

/* Take a factored panel, of which the rows from `down` on are given, from another that begins there. */
INLINE void take(const double *factored, double *to, int64_t width, int64_t down, const double *pivot)
{
    four by[COLUMNS][COLUMNS];
    for (int p = 0; p < COLUMNS; p++)
        for (int k = 0; k < COLUMNS; k++)
            by[k][p] = (four){} + factored[p * width + down + k] * pivot[p];
    for (int64_t row = down; row < width; row += 4) {
        const double *from = factored + row;
        four a = *(const four *)from, b = *(const four *)(from + width);
        four c = *(const four *)(from + 2 * width), d = *(const four *)(from + 3 * width);
        for (int k = 0; k < COLUMNS; k++)
            *(four *)(to + k * width + row - down) -= (by[k][0] * a + by[k][1] * b) + (by[k][2] * c + by[k][3] * d);
    }
}

/* Solve with a factored panel's columns of L and take them from what is right of the equations below. */
INLINE void forwards(const double *panel, int64_t width, double *restrict right)
{
    const double *a = panel, *b = a + width, *c = b + width, *d = c + width;
    right[1] -= a[1] * right[0];
    right[2] -= a[2] * right[0] + b[2] * right[1];
    right[3] -= a[3] * right[0] + b[3] * right[1] + c[3] * right[2];
    double f0 = right[0], f1 = right[1], f2 = right[2], f3 = right[3];
    for (int64_t row = COLUMNS; row < width; row++)
        right[row] -= (f0 * a[row] + f1 * b[row]) + (f2 * c[row] + f3 * d[row]);
}

INLINE void backwards(const double *panel, int64_t width, double *right)
{
    double sums[COLUMNS];
    for (int p = 0; p < COLUMNS; p++) {
        const double *own = panel + p * width;
        double lanes[4] = {0.0, 0.0, 0.0, 0.0}; /* a sum in one piece would wait for every addend */
        for (int64_t row = COLUMNS; row < width; row += 4)
            for (int lane = 0; lane < 4; lane++)
                lanes[lane] += own[row + lane] * right[row + lane];
        sums[p] = (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    }
    for (int p = COLUMNS - 1; p >= 0; p--) {
        for (int k = p + 1; k < COLUMNS; k++)
            sums[p] += panel[p * width + k] * right[k];
        right[p] -= sums[p];
    }
}

TUNED static int solve(const chain *of, int64_t panels, double *factors, double *right)
{
    int64_t width = of->width, area = COLUMNS * width, reach = width / COLUMNS;
    for (int64_t k = 0; k < reach && k < panels; k++)
        fill(of, COLUMNS * k, factors + k * area);
    for (int64_t k = 0; k < panels; k++) {
        double *own = factors + k * area, *at = right + COLUMNS * k, pivot[COLUMNS];
        if (!factor(own, width, pivot))
            return 0;
        int64_t last = k + reach < panels ? k + reach : panels;
        for (int64_t other = k + 1; other < last; other++)
            take(own, factors + other * area, width, COLUMNS * (other - k), pivot);
        if (k + reach < panels) /* now, not all beforehand: it stays in the cache until it is factored */
            fill(of, COLUMNS * (k + reach), factors + (k + reach) * area);
        forwards(own, width, at);
        for (int p = 0; p < COLUMNS; p++)
            own[p * width + p] = pivot[p];
    }
    for (int64_t k = panels - 1; k >= 0; k--) {
        double *own = factors + k * area, *at = right + COLUMNS * k;
        for (int p = 0; p < COLUMNS; p++)
            at[p] /= own[p * width + p];
        backwards(own, width, at);
    }
    return 1;
}

/* Solve for a chain of `rings` rings of `round` unknowns, three or more.
 *
 * diagonal, along, across  of each unknown its own coefficient, that with the next round the ring, and that with
 *                          the next ring's (nothing in the last)
 * right                    right side; the solution on return
 *
 * Returns 1; 0 where the matrix is not positive definite or memory is short.
 */
EXPORT int stackloft_solve_rings(int64_t rings, int64_t round, const double *diagonal, const double *along,
                                 const double *across, double *right)
{
    int64_t size = rings * round, panels = (size + COLUMNS - 1) / COLUMNS;
    chain of = {size, round, (round + 2 * COLUMNS - 1) / COLUMNS * COLUMNS, diagonal, along, across};
    double *factors = malloc(sizeof(double) * (size_t)(panels * COLUMNS * of.width));
    double *padded = calloc((size_t)(panels * COLUMNS + of.width), sizeof(double));
    int solved = factors && padded;
    if (solved) {
        memcpy(padded, right, sizeof(double) * (size_t)size);
        solved = solve(&of, panels, factors, padded);
        memcpy(right, padded, sizeof(double) * (size_t)size);
    }
    free(factors), free(padded);
    return solved;
}
