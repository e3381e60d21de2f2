/* Points and slopes on a stack's closed piecewise cubics: what geometry/curve_stack.py does, sample by sample. */
#include <math.h>

#include "cubic.h"

enum { WALK = 8 };

typedef struct {
    const double *knots, *starts, *points, *ends, *leaving, *arriving; /* the last four: x of all, then y */
    const int64_t *first;
    int64_t sections, segments;
} curves;

/* The last segment, from `low` on and before `high`, whose knot is not beyond g; the first where there is none. */
static int64_t segment_of(const double *knots, int64_t low, int64_t high, int64_t guess, double g)
{
    guess = guess < low ? low : guess >= high ? high - 1 : guess;
    if (knots[guess] <= g) {
        low = guess;
        for (int step = 0; step < WALK && low + 1 < high; step++, low++)
            if (knots[low + 1] > g)
                return low;
    } else {
        high = guess;
        for (int step = 0; step < WALK && high > low; step++, high--)
            if (knots[high - 1] <= g)
                return high - 1;
    }
    while (high - low > 1) { /* vertices are at very uneven steps */
        int64_t middle = low + (high - low) / 2;
        if (knots[middle] <= g)
            low = middle;
        else
            high = middle;
    }
    return low;
}

TUNED static int64_t sampled(const curves *of, int64_t count, const int64_t *section, const double *s, double *out)
{
    int64_t last = 0, before = -1;
    for (int64_t i = 0; i < count; i++) {
        int64_t own = section[i];
        if (own < 0 || own >= of->sections)
            return 0;
        int64_t low = of->first[own], high = of->first[own + 1];
        if (own != before)
            last = low, before = own;
        double turns = s[i] + of->starts[own], g = turns - floor(turns) + (double)own;
        /* most vertices are at even steps, and most samples in order */
        double around = (double)(high - low), ahead = (g - of->knots[last]) * around;
        int64_t guess = last + (fabs(ahead) <= around ? (int64_t)ahead : 0);
        last = segment_of(of->knots, low, high, guess, g);
        double knot = of->knots[last], span = of->knots[last + 1] - knot, x = (g - knot) / span;
        for (int axis = 0; axis < 2; axis++) {
            int64_t at = last + axis * of->segments;
            on_cubic found = along_cubic(of->points[at], of->ends[at], of->leaving[at], of->arriving[at], x);
            out[axis * count + i] = found.point;
            out[(2 + axis) * count + i] = found.along / span;
        }
    }
    return 1;
}

/* Sample closed curves, one per section, at fractions of arc length from their canonical starts.
 *
 * counts    of samples, sections and segments
 * section   of each sample; `s`: its fraction
 * first     segment of each section, and the end of the last
 * stack     knots, canonical starts, and segments' starts, ends, leaving and arriving slopes, as CurveStack has them
 * out       (2, 2, samples): points and slopes, x and y
 *
 * Returns 1; 0 where a section is not one of the stack's.
 */
EXPORT int stackloft_on_curves(const int64_t *counts, const int64_t *section, const double *s, const int64_t *first,
                               const double *const *stack, double *out)
{
    curves of = {stack[0], stack[1], stack[2], stack[3], stack[4], stack[5], first, counts[1], counts[2]};
    return (int)sampled(&of, counts[0], section, s, out);
}
