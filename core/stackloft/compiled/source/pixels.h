/* A picture's pixels, of any of the kinds of numbers that scans and photographs come in. */
#ifndef STACKLOFT_PIXELS_H
#define STACKLOFT_PIXELS_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

/* Loops compiled once more for processors with wide registers, which choose at run time. By the feature: by
 * `arch=haswell` only processors of that very generation choose it, not its successors. */
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
#define TUNED __attribute__((target_clones("avx2", "default")))
#else
#define TUNED
#endif

enum pixel_kind { INT16, UINT16, UINT8, INT8, INT32, FLOAT32, FLOAT64 };

typedef struct {
    const char *first;
    int64_t stride; /* bytes from a row to the next; a row's pixels lie side by side */
    int32_t rows, columns;
    int32_t kind;
    int32_t noisy; /* whether noise lifts empty pixels: those below `empty`, by `lift` */
    double empty, lift;
} pixels;

#define INLINE static inline __attribute__((always_inline))

INLINE double stored_as(int kind, const pixels *p, int row, int column)
{
    const char *at = p->first + row * p->stride;
    switch (kind) {
    case INT16: return ((const int16_t *)at)[column];
    case UINT16: return ((const uint16_t *)at)[column];
    case UINT8: return ((const uint8_t *)at)[column];
    case INT8: return ((const int8_t *)at)[column];
    case INT32: return ((const int32_t *)at)[column];
    case FLOAT32: return ((const float *)at)[column];
    default: return ((const double *)at)[column];
    }
}

/* The grey level without what noise adds to empty pixels (geometry/noise_floor.py). */
INLINE double grey_as(int kind, const pixels *p, int row, int column)
{
    double value = stored_as(kind, p, row, column);
    return p->noisy && value < p->empty ? value - p->lift : value;
}

/* Do something with the kind of numbers known to the compiler, which then looks it up outside of all loops. */
#define FOR_KIND(KIND, DO)                                                                           \
    switch (KIND) {                                                                                  \
    case INT16: DO(INT16); break;                                                                    \
    case UINT8: DO(UINT8); break;                                                                    \
    case FLOAT32: DO(FLOAT32); break;                                                                \
    default: DO(KIND);                                                                               \
    }

#endif
