/* A plain event loop to measure against: one disc or point after the other, edges and vertices in a uniform grid.
   Input on stdin: edges, vertices, balls, time, radius, cell size in units of sqrt(area / edges); then ax ay bx by an
   edge, x y a vertex, x y vx vy a ball. Output: bounces seconds sum, the seconds of the best of GOES goes (-DGOES=3);
   reading and the grid are not in them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct { double ax, ay, tx, ty, nx, ny, length; } Edge;
typedef struct { double x, y; } Vertex;

static int edges, vertices, balls, columns, rows;
static double until, r, x_low, y_low, cell;
static Edge *e;
static Vertex *v;
static int *start, *listed; /* numbers of edges, then edges + number of vertices, cell by cell */

static double edge_time(const Edge *e, double x, double y, double vx, double vy) {
    double px = x - e->ax, py = y - e->ay;
    double d = px * e->nx + py * e->ny, w = vx * e->nx + vy * e->ny;
    if (d < 0) { d = -d; w = -w; }
    if (w >= 0) return INFINITY;
    double t = (d - r) / -w;
    if (t < 0) t = 0;
    double u = px * e->tx + py * e->ty + t * (vx * e->tx + vy * e->ty);
    return u >= 0 && u <= e->length ? t : INFINITY;
}

static double vertex_time(const Vertex *v, double x, double y, double vx, double vy, double square) {
    double px = x - v->x, py = y - v->y, along = px * vx + py * vy;
    if (along >= 0) return INFINITY;
    double cross = px * vy - py * vx, left = r * r - cross * cross / square;
    if (left < 0) return INFINITY;
    double t = (px * px + py * py - r * r) / (sqrt(square * left) - along);
    return t > 0 ? t : 0;
}

/* Whether an edge, or a vertex, comes within r of a cell: by its distance across and along the edge. */
static int reaches(int k, double left, double low) {
    double h = cell / 2 * (1 + 1e-9), x = left + cell / 2, y = low + cell / 2;
    if (k >= edges) {
        double dx = fmax(fabs(v[k - edges].x - x) - h, 0), dy = fmax(fabs(v[k - edges].y - y) - h, 0);
        return dx * dx + dy * dy <= r * r;
    }
    double px = x - e[k].ax, py = y - e[k].ay, across = px * e[k].nx + py * e[k].ny;
    double along = px * e[k].tx + py * e[k].ty, wide = h * (fabs(e[k].tx) + fabs(e[k].ty));
    return fabs(across) <= r + h * (fabs(e[k].nx) + fabs(e[k].ny)) && along >= -wide && along <= e[k].length + wide;
}

static int place(double offset, int count) { return fmin(fmax(offset / cell, 0), count - 1); }

static void build(double size) {
    double x1 = -1e300, y1 = -1e300;
    x_low = y_low = 1e300;
    for (int k = 0; k < edges; k++)
        for (int end = 0; end < 2; end++) {
            double x = e[k].ax + end * e[k].length * e[k].tx, y = e[k].ay + end * e[k].length * e[k].ty;
            x_low = fmin(x_low, x), y_low = fmin(y_low, y), x1 = fmax(x1, x), y1 = fmax(y1, y);
        }
    double slack = r + 1e-6 * (x1 - x_low + y1 - y_low);
    x_low -= slack, y_low -= slack, x1 += slack, y1 += slack;
    cell = size * sqrt((x1 - x_low) * (y1 - y_low) / fmax(edges, 16));
    columns = (x1 - x_low) / cell + 1, rows = (y1 - y_low) / cell + 1;
    start = calloc(columns * rows + 2, sizeof *start);
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < edges + vertices; k++) {
            double ax, ay, bx, by;
            if (k < edges)
                ax = e[k].ax, ay = e[k].ay, bx = ax + e[k].length * e[k].tx, by = ay + e[k].length * e[k].ty;
            else
                ax = bx = v[k - edges].x, ay = by = v[k - edges].y;
            int last_i = place(fmax(ax, bx) + slack - x_low, columns), last_j = place(fmax(ay, by) + slack - y_low, rows);
            for (int j = place(fmin(ay, by) - slack - y_low, rows); j <= last_j; j++)
                for (int i = place(fmin(ax, bx) - slack - x_low, columns); i <= last_i; i++)
                    if (reaches(k, x_low + i * cell, y_low + j * cell)) {
                        if (pass) listed[start[j * columns + i + 1]++] = k;
                        else start[j * columns + i + 2]++;
                    }
        }
        if (!pass) {
            for (int c = 2; c < columns * rows + 2; c++) start[c] += start[c - 1];
            listed = malloc((start[columns * rows + 1] + 1) * sizeof *listed);
        }
    }
}

/* What is met first, before best: walk the cells until it lies in those walked. */
static int search(double x, double y, double vx, double vy, int last, double *best) {
    int i = (x - x_low) / cell, j = (y - y_low) / cell, step_i = vx > 0 ? 1 : -1, step_j = vy > 0 ? 1 : -1, hit = -1;
    double next_i = vx != 0 ? (x_low + (i + (vx > 0)) * cell - x) / vx : INFINITY;
    double next_j = vy != 0 ? (y_low + (j + (vy > 0)) * cell - y) / vy : INFINITY;
    double each_i = fabs(cell / vx), each_j = fabs(cell / vy), square = vx * vx + vy * vy;
    while ((unsigned)i < (unsigned)columns && (unsigned)j < (unsigned)rows) {
        int c = j * columns + i;
        for (int k = start[c]; k < start[c + 1]; k++) {
            int one = listed[k];
            if (one == last) continue;
            double t = one < edges ? edge_time(&e[one], x, y, vx, vy) : vertex_time(&v[one - edges], x, y, vx, vy, square);
            if (t < *best) *best = t, hit = one;
        }
        if (*best <= fmin(next_i, next_j)) break;
        if (next_i < next_j) i += step_i, next_i += each_i;
        else j += step_j, next_j += each_j;
    }
    return hit;
}

static long fly(double *b) {
    double x = b[0], y = b[1], vx = b[2], vy = b[3], left = until;
    long bounces = 0;
    for (int last = -1;; bounces++) {
        double best = left, nx, ny;
        int hit = search(x, y, vx, vy, last, &best);
        x += best * vx, y += best * vy, left -= best;
        if (hit < 0) break;
        if (hit < edges) nx = e[hit].nx, ny = e[hit].ny;
        else nx = x - v[hit - edges].x, ny = y - v[hit - edges].y;
        double k = 2 * (vx * nx + vy * ny) / (nx * nx + ny * ny);
        vx -= k * nx, vy -= k * ny, last = hit;
    }
    b[0] = x;
    return bounces;
}

int main(void) {
    double size, sum = 0;
    if (scanf("%d %d %d %lf %lf %lf", &edges, &vertices, &balls, &until, &r, &size) != 6) return 2;
    e = malloc((edges + 1) * sizeof *e), v = malloc((vertices + 1) * sizeof *v);
    double (*b)[4] = malloc((balls + 1) * sizeof *b);
    for (int i = 0; i < edges; i++) {
        double bx, by;
        if (scanf("%lf %lf %lf %lf", &e[i].ax, &e[i].ay, &bx, &by) != 4) return 2;
        e[i].length = hypot(bx - e[i].ax, by - e[i].ay);
        e[i].tx = (bx - e[i].ax) / e[i].length, e[i].ty = (by - e[i].ay) / e[i].length;
        e[i].nx = e[i].ty, e[i].ny = -e[i].tx;
    }
    for (int i = 0; i < vertices; i++)
        if (scanf("%lf %lf", &v[i].x, &v[i].y) != 2) return 2;
    for (int i = 0; i < balls; i++)
        if (scanf("%lf %lf %lf %lf", &b[i][0], &b[i][1], &b[i][2], &b[i][3]) != 4) return 2;
    build(size);
    long bounces = 0;
    double seconds = INFINITY;
    for (int go = 0; go < GOES; go++) {
        clock_t begin = clock();
        bounces = 0, sum = 0;
        for (int i = 0; i < balls; i++) {
            double ball[4] = {b[i][0], b[i][1], b[i][2], b[i][3]};
            bounces += fly(ball);
            sum += ball[0];
        }
        seconds = fmin(seconds, (double)(clock() - begin) / CLOCKS_PER_SEC);
    }
    printf("%ld %.9g %.3g\n", bounces, seconds, sum);
    return 0;
}
