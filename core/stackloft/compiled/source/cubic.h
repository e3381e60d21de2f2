/* One coordinate of a cubic by its ends and the slopes there (geometry/curve_measures.py, along_cubics). */
#ifndef STACKLOFT_CUBIC_H
#define STACKLOFT_CUBIC_H

#include "pixels.h"

typedef struct {
    double point, along;
} on_cubic;

INLINE on_cubic along_cubic(double p0, double p1, double d0, double d1, double t)
{
    double rise = p1 - p0, skew = rise - d1 - d0 + rise, bend = skew * t + d0 - rise, bow = t * (1.0 - t);
    on_cubic at = {rise * t + p0 + bow * bend, rise + bend * (1.0 - 2.0 * t) + skew * bow};
    return at;
}

#endif
