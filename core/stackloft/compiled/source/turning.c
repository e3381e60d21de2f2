/* Whether a traced loop may have a corner: straight lines fitted behind and ahead of samples along it, as
 * sectioning/turning_loops.py does it for many loops at once. */
#include <math.h>
#include <stdlib.h>

#include "pixels.h"
#include "threads.h"

typedef struct {
    double x, y;
} place;

/* Sample the way round a polygon evenly; `along` has one distance more than there are vertices. */
static void resampled(const double *points, int64_t length, const double *along, double pixel, int64_t count,
                      place *samples)
{
    double step = along[length] / (double)count;
    int64_t k = 0;
    for (int64_t j = 0; j < count; j++) {
        double at = (double)j * step;
        while (k + 1 < length && along[k + 1] <= at)
            k++;
        const double *here = points + 2 * k, *next = points + 2 * (k + 1 < length ? k + 1 : 0);
        double reach = along[k + 1] - along[k], part = reach > 0.0 ? (at - along[k]) / reach : 0.0;
        samples[j].x = (here[0] - points[0] + part * (next[0] - here[0])) / pixel;
        samples[j].y = (here[1] - points[1] + part * (next[1] - here[1])) / pixel;
    }
}

/* Work out the slopes, times a constant, of the lines fitted to the samples `near` … `far` after each: sums of
 * the samples and of their moments, of which one sample's differ from the last one's by the ends alone. */
static void slopes(const place *samples, int64_t count, int near, int far, place *sides)
{
    double middle = 0.5 * (near + far);
    place sum = {0.0, 0.0}, moment = {0.0, 0.0};
    for (int k = near; k <= far; k++) {
        const place *one = samples + k % count;
        sum.x += one->x, sum.y += one->y;
        moment.x += (k - middle) * one->x, moment.y += (k - middle) * one->y;
    }
    int64_t first = near % count, next = (far + 1) % count;
    for (int64_t k = 0; k < count; k++) {
        sides[k] = moment;
        const place *left = samples + first, *come = samples + next;
        sum.x += come->x - left->x, sum.y += come->y - left->y;
        moment.x += (far + 1 - middle) * come->x - (near - middle) * left->x - sum.x;
        moment.y += (far + 1 - middle) * come->y - (near - middle) * left->y - sum.y;
        first = first + 1 < count ? first + 1 : 0;
        next = next + 1 < count ? next + 1 : 0;
    }
}

static int turns(const place *samples, int64_t count, int near, int far, double least_cosine, place *sides)
{
    slopes(samples, count, near, far, sides);
    int64_t apart = near + far;
    for (int64_t k = 0; k < count; k++) {
        place behind = sides[(k + count - apart) % count], ahead = sides[k];
        double along = behind.x * ahead.x + behind.y * ahead.y, across = behind.x * ahead.y - behind.y * ahead.x;
        if (along <= least_cosine * sqrt(along * along + across * across))
            return 1;
    }
    return 0;
}

typedef struct {
    const double *points;
    int64_t length;
    double pixel;
    int32_t answer; /* out */
} turn_job;

typedef struct {
    double shortest, wide, least_cosine; /* pixels; pixels between samples; of the angle of two lines */
    int32_t near, far;                   /* samples off, of those that lines are fitted to */
    turn_job *loops;
} turn_jobs;

/* Answer 1 when the loop may turn sharply somewhere, or is shorter than `shortest` pixels; 0 when it surely does
 * not; -1 when memory is short. */
static void look_for_corners(void *jobs, int64_t number)
{
    const turn_jobs *rules = jobs;
    turn_job *job = rules->loops + number;
    const double *points = job->points;
    int64_t length = job->length;
    job->answer = -1;
    double *along = malloc((size_t)(length + 1) * sizeof(double));
    if (!along)
        return;
    along[0] = 0.0;
    for (int64_t k = 0; k < length; k++) {
        const double *here = points + 2 * k, *next = points + 2 * (k + 1 < length ? k + 1 : 0);
        double x = (next[0] - here[0]) / job->pixel, y = (next[1] - here[1]) / job->pixel;
        along[k + 1] = along[k] + sqrt(x * x + y * y);
    }
    int64_t count = llrint(along[length] / rules->wide);
    if (along[length] >= rules->shortest && count > rules->near + rules->far) {
        place *samples = malloc(2 * (size_t)count * sizeof(place));
        if (samples) {
            resampled(points, length, along, job->pixel, count, samples);
            job->answer = turns(samples, count, rules->near, rules->far, rules->least_cosine, samples + count);
        }
        free(samples);
    } else
        job->answer = 1;
    free(along);
}

EXPORT void stackloft_may_turn(turn_jobs *jobs, int64_t count, int threads)
{
    for_each(look_for_corners, jobs, count, threads);
}
