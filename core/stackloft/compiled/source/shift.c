/* Stored 16-bit values shifted by a whole number, in place, as most CT scanners' are by -1024. */
#include "pixels.h"

#define SHIFTED(NAME, TYPE)                                                                          \
    TUNED static void NAME(TYPE *values, int64_t count, uint16_t by, int32_t *ends)                  \
    {                                                                                                \
        TYPE low = values[0], high = values[0];                                                      \
        for (int64_t k = 0; k < count; k++) {                                                        \
            TYPE value = values[k];                                                                  \
            low = value < low ? value : low;                                                         \
            high = value > high ? value : high;                                                      \
            values[k] = (TYPE)(uint16_t)((uint16_t)value + by);                                      \
        }                                                                                            \
        ends[0] = low, ends[1] = high;                                                               \
    }

SHIFTED(signed_shifted, int16_t)
SHIFTED(unsigned_shifted, uint16_t)

/* Add `by`, modulo 2¹⁶, to count ≥ 1 values; `ends` out: the least and the greatest as they were. */
EXPORT void stackloft_shift(void *values, int64_t count, int is_signed, int by, int32_t *ends)
{
    if (is_signed)
        signed_shifted(values, count, (uint16_t)by, ends);
    else
        unsigned_shifted(values, count, (uint16_t)by, ends);
}
