/* Stored values read from files where they lie as they are, and 16-bit ones shifted, as most CT scanners' are
 * by -1024. */
#define _POSIX_C_SOURCE 200809L
#include "pixels.h"
#include "threads.h"

#if !defined(_WIN32)
#include <fcntl.h>
#include <unistd.h>
#endif

enum { AS_IT_IS, SIGNED, UNSIGNED };

typedef struct {
    const char *path; /* NULL: the values are there already */
    int64_t at, bytes;
    void *to;
    int32_t kind, by;  /* 16-bit values, signed or not, are shifted by a number, modulo 2^16 */
    int32_t low, high; /* out: the least and the greatest of them as they were */
    int32_t done;      /* out: whether all bytes were there */
} file_part;

#define SHIFTED(NAME, TYPE)                                                                          \
    TUNED static void NAME(TYPE *values, int64_t count, uint16_t by, int32_t *low_out, int32_t *high_out) \
    {                                                                                                \
        TYPE low = values[0], high = values[0];                                                      \
        for (int64_t k = 0; k < count; k++) {                                                        \
            TYPE value = values[k];                                                                  \
            low = value < low ? value : low;                                                         \
            high = value > high ? value : high;                                                      \
            values[k] = (TYPE)(uint16_t)((uint16_t)value + by);                                      \
        }                                                                                            \
        *low_out = low, *high_out = high;                                                            \
    }

SHIFTED(signed_shifted, int16_t)
SHIFTED(unsigned_shifted, uint16_t)

static int read_whole(const file_part *part)
{
#if defined(_WIN32)
    return part->path == NULL;
#else
    if (!part->path)
        return 1;
    int file = open(part->path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return 0;
    int64_t done = 0;
    while (done < part->bytes) {
        ssize_t got = pread(file, (char *)part->to + done, (size_t)(part->bytes - done), (off_t)(part->at + done));
        if (got <= 0)
            break;
        done += got;
    }
    close(file);
    return done == part->bytes;
#endif
}

static void read_one(void *parts, int64_t number)
{
    file_part *part = (file_part *)parts + number;
    part->done = read_whole(part);
    if (!part->done || part->bytes < 2)
        return;
    if (part->kind == SIGNED)
        signed_shifted(part->to, part->bytes / 2, (uint16_t)part->by, &part->low, &part->high);
    if (part->kind == UNSIGNED)
        unsigned_shifted(part->to, part->bytes / 2, (uint16_t)part->by, &part->low, &part->high);
}

EXPORT void stackloft_read(file_part *parts, int64_t count, int threads)
{
    for_each(read_one, parts, count, threads);
}
