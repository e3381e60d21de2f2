/* A slice's body where it is one piece without a hole: its border pixels in order, and whether it closes
 * background in. Suzuki & Abe (1985), as OpenCV's findContours follows outer borders. */
#include <stdlib.h>

#include "bits.h"
#include "threads.h"

enum { RIGHT, LEFT = 4 };
/* Neighbours counter-clockwise as seen, from the right: columns and rows to them. */
static const int DX[8] = {1, 1, 0, -1, -1, -1, 0, 1};
static const int DY[8] = {0, -1, -1, -1, 0, 1, 1, 1};

typedef struct {
    int32_t *chain; /* column, row of each border pixel */
    int64_t length, capacity;
    int64_t beside; /* edges between a pixel of the border and background to its left or right, passed */
    int pinched;    /* a step between two pixels that touch by their corners alone */
} border;

/* Count the edges to the left and right that one passes turning from the way back to the way ahead. */
static int passed_beside(int back, int ahead)
{
    int count = 0;
    for (int way = (back + 1) & 7; way != ahead; way = (way + 1) & 7)
        count += way == RIGHT || way == LEFT;
    return count;
}

static int follow(const bits *body, int row, int column, border *found)
{
    int way = LEFT, y = row, x = column;
    do { /* the last neighbour before the background on the left, going round clockwise */
        way = (way + 7) & 7;
        if (bit_at(body, y + DY[way], x + DX[way]))
            break;
    } while (way != LEFT);
    if (way == LEFT) {
        found->chain[0] = x, found->chain[1] = y;
        found->length = 1, found->beside = 2;
        return 1;
    }
    int last_x = x + DX[way], last_y = y + DY[way];
    for (;;) {
        int back = way;
        do
            way = (way + 1) & 7;
        while (!bit_at(body, y + DY[way], x + DX[way]));
        if (found->length == found->capacity)
            return 0;
        found->chain[2 * found->length] = x, found->chain[2 * found->length + 1] = y;
        found->length++;
        found->beside += passed_beside(back, way);
        if (way & 1 && !bit_at(body, y, x + DX[way]) && !bit_at(body, y + DY[way], x))
            found->pinched = 1;
        int next_x = x + DX[way], next_y = y + DY[way];
        if (next_x == column && next_y == row && x == last_x && y == last_y)
            return 1;
        x = next_x, y = next_y;
        way = (way + 4) & 7;
    }
}

/* Count the runs of a mask's rows, each with one edge to its left and one to its right; where it lies. */
TUNED static int64_t runs_of(const bits *mask, int32_t *box, int64_t *count)
{
    int64_t runs = 0;
    int top = -1, bottom = 0, left = mask->columns, right = 0;
    *count = 0;
    for (int row = 0; row < mask->rows; row++) {
        const uint64_t *words = bits_row(mask, row);
        uint64_t before = 0;
        int shown = 0;
        for (int k = 0; k < mask->width; k++) {
            uint64_t own = words[k];
            if (own) {
                int first = 64 * k + __builtin_ctzll(own), last = 64 * k + 64 - __builtin_clzll(own);
                left = first < left ? first : left;
                right = last > right ? last : right;
                shown = 1;
                *count += __builtin_popcountll(own);
                runs += __builtin_popcountll(own & ~(own << 1 | before >> 63));
            }
            before = own;
        }
        if (shown) {
            top = top < 0 ? row : top;
            bottom = row + 1;
        }
    }
    box[0] = top, box[1] = left, box[2] = bottom - top, box[3] = right - left;
    return runs;
}

/* Return the holes of a mask that is one 8-connected piece: one less its Euler number (Gray 1971). */
TUNED static int64_t holes_of(const bits *mask)
{
    int64_t one = 0, three = 0, slanting = 0;
    for (int row = -1; row < mask->rows; row++) {
        const uint64_t *above = row >= 0 ? bits_row(mask, row) : NULL;
        const uint64_t *below = row + 1 < mask->rows ? bits_row(mask, row + 1) : NULL;
        uint64_t before_above = 0, before_below = 0;
        for (int k = 0; k <= mask->width; k++) { /* one word more: the last pixel may end a word */
            uint64_t b = above && k < mask->width ? above[k] : 0, d = below && k < mask->width ? below[k] : 0;
            uint64_t a = b << 1 | before_above >> 63, c = d << 1 | before_below >> 63;
            uint64_t odd = a ^ b ^ c ^ d, many = odd & ((a & b) | (c & d));
            three += __builtin_popcountll(many);
            one += __builtin_popcountll(odd & ~many);
            slanting += __builtin_popcountll((a & d & ~b & ~c) | (b & c & ~a & ~d));
            before_above = b, before_below = d;
        }
    }
    return 1 - (one - three - 2 * slanting) / 4;
}

/* Take a piece out of a mask (8-connected), and return its pixels; `stack` holds as many as the mask has. */
static int64_t taken_out(bits *mask, int row, int column, int32_t *stack)
{
    int64_t size = 0, top = 0;
    stack[top++] = row * mask->columns + column;
    bits_row(mask, row)[column >> 6] &= ~(UINT64_C(1) << (column & 63));
    while (top) {
        int32_t at = stack[--top];
        int y = at / mask->columns, x = at % mask->columns;
        size++;
        for (int way = 0; way < 8; way++) {
            int to_y = y + DY[way], to_x = x + DX[way];
            if (!bit_at(mask, to_y, to_x))
                continue;
            bits_row(mask, to_y)[to_x >> 6] &= ~(UINT64_C(1) << (to_x & 63));
            stack[top++] = to_y * mask->columns + to_x;
        }
    }
    return size;
}

static int64_t largest_piece(bits *mask, int64_t count)
{
    int32_t *stack = malloc((size_t)count * sizeof(int32_t) + 1);
    int64_t largest = stack ? 0 : INT64_MAX;
    for (int row = 0; stack && row < mask->rows; row++)
        for (int k = 0; k < mask->width; k++)
            while (bits_row(mask, row)[k]) {
                int column = 64 * k + __builtin_ctzll(bits_row(mask, row)[k]);
                int64_t size = taken_out(mask, row, column, stack);
                largest = size > largest ? size : largest;
            }
    free(stack);
    return largest;
}

/* Return whether a disc closes in no background of a solid piece, and no crack of `fewest` pixels or more. */
static int surely_open(const bits *whole, const int32_t *box, int frame, int radius, const int32_t *half,
                       int fewest)
{
    bits body = bits_new(box[2] + 2 * frame, box[3] + 2 * frame), wide = {0}, shut = {0};
    int open = 0;
    if (body.words) {
        bits_placed(whole, &body, frame - box[0], frame - box[1]);
        if (bits_dilated(&body, &wide, radius, half) && holes_of(&wide) == 0 &&
            bits_eroded(&wide, &shut, radius, half)) {
            int64_t words = (int64_t)body.rows * body.width;
            for (int64_t k = 0; k < words; k++)
                shut.words[k] &= ~body.words[k];
            int64_t added = bits_count(&shut);
            open = added < fewest || largest_piece(&shut, added) < fewest;
        }
    }
    free(body.words), free(wide.words), free(shut.words);
    return open;
}

typedef struct {
    pixels picture;
    double level;
    int32_t *chain; /* room for `capacity` border pixels (column, row), from the leftmost of the first row on */
    int64_t capacity;
    const int32_t *half; /* the closing disc's reach in each of its rows, from the middle one outwards */
    int32_t radius, fewest, frame;
    int32_t answer;                /* out */
    int32_t box[4];                /* out: top, left, rows, columns */
    int64_t length, count, closed; /* out: border pixels, body's pixels, whether it may close background in */
} solid_job;

/* Find the body of a slice where it is simple.
 *
 * Answers 0 when nothing lies above the level, 1 when the body is one 4-connected piece without a hole, nowhere
 * held together by corners alone, and -1 when it is not so simple (or memory or `capacity` is short).
 */
static void find_solid(void *jobs, int64_t number)
{
    solid_job *job = (solid_job *)jobs + number;
    job->answer = -1;
    bits body = bits_above(&job->picture, job->level);
    if (!body.words)
        return;
    border found = {job->chain, 0, job->capacity, 0, 0};
    int32_t *box = job->box, frame = job->frame;
    int64_t runs = runs_of(&body, box, &job->count);
    if (!runs)
        job->answer = 0;
    else {
        const uint64_t *words = bits_row(&body, box[0]);
        int first = 0;
        while (!words[first])
            first++;
        first = 64 * first + __builtin_ctzll(words[first]);
        /* any other piece, or a hole, has edges to the left and right that this border does not pass */
        if (follow(&body, box[0], first, &found) && !found.pinched && found.beside == 2 * runs) {
            job->length = found.length;
            int apart = box[0] >= frame && box[1] >= frame && box[0] + box[2] + frame <= body.rows &&
                        box[1] + box[3] + frame <= body.columns;
            job->closed = !(apart && surely_open(&body, box, frame, job->radius, job->half, job->fewest));
            job->answer = 1;
        }
    }
    free(body.words);
}

EXPORT void stackloft_solid_pieces(solid_job *jobs, int64_t count, int threads)
{
    for_each(find_solid, jobs, count, threads);
}
