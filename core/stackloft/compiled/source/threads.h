/* Work on many slices or loops shared out among threads that know nothing of the interpreter's lock. */
#ifndef STACKLOFT_THREADS_H
#define STACKLOFT_THREADS_H

#include <stdint.h>

/* Call job(jobs, number) for each number from 0 to count - 1, in any order; one job writes to nothing that another
 * one reads or writes. At most `threads` threads work, the caller's among them. */
void for_each(void (*job)(void *jobs, int64_t number), void *jobs, int64_t count, int threads);

#endif
