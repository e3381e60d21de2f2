/* A few threads that wait for work. The caller works too and waits for nobody who has not begun: where all
 * processors are taken by others it does everything itself, as soon as it would have alone. */
#define _POSIX_C_SOURCE 200809L
#include "threads.h"

static void alone(void (*job)(void *, int64_t), void *jobs, int64_t count)
{
    for (int64_t number = 0; number < count; number++)
        job(jobs, number);
}

#if defined(_WIN32)

void for_each(void (*job)(void *, int64_t), void *jobs, int64_t count, int threads)
{
    (void)threads;
    alone(job, jobs, count);
}

#else

#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <unistd.h>

enum { MOST = 16 };

static struct {
    pthread_mutex_t lock; /* of all that follows */
    pthread_cond_t wake, done;
    void (*job)(void *, int64_t);
    void *jobs;
    int64_t count, next; /* of the caller's jobs; the next one that nobody has taken */
    int taken;           /* whether somebody's jobs are in hand */
    int working, workers;
} pool = {.lock = PTHREAD_MUTEX_INITIALIZER, .wake = PTHREAD_COND_INITIALIZER, .done = PTHREAD_COND_INITIALIZER};

static atomic_int owner; /* the process whose threads they are: a fork of it has none */

/* Take the next job and do it; the lock is held before and after. */
static void do_next(void)
{
    int64_t number = pool.next++;
    pthread_mutex_unlock(&pool.lock);
    pool.job(pool.jobs, number);
    pthread_mutex_lock(&pool.lock);
}

static void *work(void *nothing)
{
    (void)nothing;
    pthread_mutex_lock(&pool.lock);
    for (;;) {
        while (pool.next >= pool.count)
            pthread_cond_wait(&pool.wake, &pool.lock);
        pool.working++;
        do_next();
        if (--pool.working == 0 && pool.next >= pool.count)
            pthread_cond_signal(&pool.done);
    }
    return NULL;
}

/* Start a thread that no signal interrupts: these are for the program's own. */
static int started(void)
{
    pthread_t thread;
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int failed = pthread_create(&thread, NULL, work, NULL);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!failed)
        pthread_detach(thread);
    return !failed;
}

void for_each(void (*job)(void *, int64_t), void *jobs, int64_t count, int threads)
{
    int none = 0, mine = (int)getpid();
    if (threads < 2 || count < 2 || (!atomic_compare_exchange_strong(&owner, &none, mine) && none != mine)) {
        alone(job, jobs, count);
        return;
    }
    pthread_mutex_lock(&pool.lock);
    if (pool.taken) { /* by another thread of the program */
        pthread_mutex_unlock(&pool.lock);
        alone(job, jobs, count);
        return;
    }
    pool.taken = 1;
    while (pool.workers < threads - 1 && pool.workers < MOST && started())
        pool.workers++;
    pool.job = job, pool.jobs = jobs, pool.count = count, pool.next = 0;
    pthread_cond_broadcast(&pool.wake);
    while (pool.next < pool.count)
        do_next();
    while (pool.working)
        pthread_cond_wait(&pool.done, &pool.lock);
    pool.count = pool.next = 0;
    pool.taken = 0;
    pthread_mutex_unlock(&pool.lock);
}

#endif
