/* A closed loop's least-squares cubic spline on even knots, sampled evenly: what sectioning/smoothing.py and
 * geometry/uniform_spline.py do, one loop at a time. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "pixels.h"
#include "threads.h"

enum { BUMPS = 4, POWERS = 7, ROUND = 4, OVERLAP = 10, FEWEST_SAMPLES = 16, SHORTEST = 12 };

static const double BASIS[BUMPS][4] = {{1 / 6.0, -3 / 6.0, 3 / 6.0, -1 / 6.0},
                                       {4 / 6.0, 0, -6 / 6.0, 3 / 6.0},
                                       {1 / 6.0, 3 / 6.0, 3 / 6.0, -3 / 6.0},
                                       {0, 0, 0, 1 / 6.0}};

/* Of every two bumps, the product's powers of the place in a span. */
static void products_of(double products[BUMPS][BUMPS][POWERS])
{
    memset(products, 0, sizeof(double) * BUMPS * BUMPS * POWERS);
    for (int a = 0; a < BUMPS; a++)
        for (int b = 0; b < BUMPS; b++)
            for (int i = 0; i < 4; i++)
                for (int j = 0; j < 4; j++)
                    products[a][b][i + j] += BASIS[a][i] * BASIS[b][j];
}

typedef struct {
    double power[POWERS]; /* Σ xᵏ over a span's vertices */
    double x[BUMPS], y[BUMPS];
    int64_t count;
} moments;

typedef struct {
    int64_t spans, count, samples;
    double *t;        /* of each vertex, in spans from the overlap's start */
    const double *at; /* vertices, once round */
    int64_t length, before;
} wrapped;

static void add_vertex(moments *to, double x, const double *point)
{
    double power = 1.0;
    for (int k = 0; k < POWERS; k++) {
        to->power[k] += power;
        if (k < BUMPS) {
            to->x[k] += power * point[0];
            to->y[k] += power * point[1];
        }
        power *= x;
    }
    to->count++;
}

/* Fill the normal equations, lower bands column by column; return whether each span has two vertices. */
static int normal_equations(const wrapped *loop, double (*bands)[BUMPS], double (*right)[2])
{
    moments *sums = calloc((size_t)loop->spans, sizeof(moments));
    int even = sums != NULL;
    for (int64_t k = 0; even && k < loop->count; k++) {
        int64_t span = (int64_t)loop->t[k];
        even = span >= 0 && span < loop->spans;
        if (even)
            add_vertex(sums + span, loop->t[k] - (double)span, loop->at + 2 * ((loop->before + k) % loop->length));
    }
    double products[BUMPS][BUMPS][POWERS];
    products_of(products);
    for (int64_t span = 0; even && span < loop->spans; span++) {
        const moments *own = sums + span;
        even = own->count >= 2;
        for (int a = 0; a < BUMPS; a++) {
            for (int b = a; b < BUMPS; b++)
                for (int k = 0; k < POWERS; k++)
                    bands[span + a][b - a] += products[a][b][k] * own->power[k];
            for (int k = 0; k < 4; k++) {
                right[span + a][0] += BASIS[a][k] * own->x[k];
                right[span + a][1] += BASIS[a][k] * own->y[k];
            }
        }
    }
    free(sums);
    return even;
}

/* Solve in place: Cholesky's factors of a matrix with three bands below its diagonal. */
static int solve(int64_t size, double (*bands)[BUMPS], double (*right)[2])
{
    for (int64_t j = 0; j < size; j++) {
        double pivot = bands[j][0];
        if (!(pivot > 0.0))
            return 0;
        bands[j][0] = pivot = sqrt(pivot);
        int64_t below = size - 1 - j < BUMPS - 1 ? size - 1 - j : BUMPS - 1;
        for (int64_t i = 1; i <= below; i++)
            bands[j][i] /= pivot;
        for (int64_t i = 1; i <= below; i++)
            for (int64_t k = i; k <= below; k++)
                bands[j + i][k - i] -= bands[j][i] * bands[j][k];
        for (int axis = 0; axis < 2; axis++) {
            right[j][axis] /= pivot;
            for (int64_t i = 1; i <= below; i++)
                right[j + i][axis] -= bands[j][i] * right[j][axis];
        }
    }
    for (int64_t j = size - 1; j >= 0; j--)
        for (int axis = 0; axis < 2; axis++) {
            for (int64_t i = 1; i < BUMPS && j + i < size; i++)
                right[j][axis] -= bands[j][i] * right[j + i][axis];
            right[j][axis] /= bands[j][0];
        }
    return 1;
}

static void sampled(const wrapped *loop, const double (*solved)[2], double step, double from, double *out)
{
    int64_t last = -1;
    double cubic[2][4] = {{0}};
    for (int64_t k = 0; k < loop->samples; k++) {
        double t = (double)k * step + from;
        int64_t span = (int64_t)t < loop->spans - 1 ? (int64_t)t : loop->spans - 1;
        for (int axis = 0; axis < 2 && span != last; axis++)
            for (int power = 0; power < 4; power++) {
                cubic[axis][power] = 0.0;
                for (int a = 0; a < BUMPS; a++)
                    cubic[axis][power] += BASIS[a][power] * solved[span + a][axis];
            }
        last = span;
        double x = t - (double)span;
        for (int axis = 0; axis < 2; axis++) {
            const double *c = cubic[axis];
            out[2 * k + axis] = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
        }
    }
}

static double at_most(double wanted, double most) { return nearbyint(wanted < most ? wanted : most); }

/* Wrap a loop on itself; `t` has room for three rounds. Returns the parameter of the first sample. */
static double wrap(wrapped *loop, double spacing, double step, double fewest, double *sample_step)
{
    int64_t n = loop->length;
    double *around = loop->t, total = 0.0;
    for (int64_t k = 0; k < n; k++) {
        const double *here = loop->at + 2 * k, *next = loop->at + 2 * (k + 1 < n ? k + 1 : 0);
        double x = next[0] - here[0], y = next[1] - here[1];
        around[k] = total;
        total += sqrt(x * x + y * y);
    }
    double spans = fmax(ROUND, at_most(fmax(total / spacing, fewest), (double)(n / 2)));
    double overlap = fmin(OVERLAP, spans), scale = spans / total;
    loop->samples = (int64_t)fmax(FEWEST_SAMPLES, at_most(total / step, 2.0 * (double)n));
    int64_t before = n, after = 0;
    while (before > 0 && around[before - 1] * scale >= spans - overlap)
        before--;
    while (after < n && around[after] * scale < overlap)
        after++;
    loop->before = before, loop->count = n - before + n + after;
    for (int64_t k = loop->count - 1; k >= 0; k--) { /* the first round's own places are needed to the end */
        int64_t at = (before + k) % n, round = (before + k) / n;
        loop->t[n + k] = around[at] * scale + ((double)round - 1.0) * spans + overlap;
    }
    loop->t += n;
    loop->spans = (int64_t)(spans + 2.0 * overlap);
    *sample_step = spans / (double)loop->samples;
    return overlap;
}

typedef struct {
    const double *points; /* vertices, none of which repeats the one before */
    int64_t length;
    double *out; /* room for `capacity` samples */
    int64_t capacity;
    int64_t count; /* out: samples; 0 where the knots cannot be even (or memory or room is short) */
} smooth_job;

typedef struct {
    double spacing, step, fewest; /* between knots, between samples; spans that there are at least */
    smooth_job *loops;
} smooth_jobs;

/* Smooth a closed loop without corners. */
static void smooth(void *jobs, int64_t number)
{
    const smooth_jobs *rules = jobs;
    smooth_job *job = rules->loops + number;
    job->count = 0;
    if (job->length < SHORTEST)
        return;
    double *places = malloc(4 * (size_t)job->length * sizeof(double));
    if (!places)
        return;
    wrapped loop = {0, 0, 0, places, job->points, job->length, 0};
    double sample_step, from = wrap(&loop, rules->spacing, rules->step, rules->fewest, &sample_step);
    size_t size = (size_t)loop.spans + BUMPS - 1;
    double(*bands)[BUMPS] = calloc(size, sizeof(*bands)), (*right)[2] = calloc(size, sizeof(*right));
    if (bands && right && loop.samples <= job->capacity && normal_equations(&loop, bands, right) &&
        solve((int64_t)size, bands, right)) {
        sampled(&loop, (const double(*)[2])right, sample_step, from, job->out);
        job->count = loop.samples;
    }
    free(bands), free(right), free(places);
}

EXPORT void stackloft_smooth_closed(smooth_jobs *jobs, int64_t count, int threads)
{
    for_each(smooth, jobs, count, threads);
}
