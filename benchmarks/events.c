/* A plain event loop to measure against: one disc or point after the other, edges and vertices in a uniform grid.
   Input on stdin: edges, vertices, balls, time, radius, cell size in units of sqrt(area / edges); then ax ay bx by an
   edge, x y a vertex, x y vx vy a ball. Output: bounces seconds sum, the seconds of the best of GOES goes (-DGOES=3);
   reading and the grid are not in them. With -DFALLS=g all falls, with the acceleration g along -y: edges are quadratics,
   vertices quartics, whose turning times are found in closed form. */
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

#ifdef FALLS
/* First time after which a t^2 + b t + c, at least 0 now, is below 0; on the wall it was left from c is 0. */
static double fall(double a, double b, double c, int left) {
    if (left) return a < 0 && b > 0 ? -b / a : INFINITY;
    if (c < 0) c = 0;
    double d = b * b - 4 * a * c;
    if (d < 0 || (b >= 0 && a >= 0)) return INFINITY;
    d = sqrt(d);
    return b > 0 ? -(b + d) / (2 * a) : 2 * c / (d - b);
}

static double edge_time(const Edge *e, double x, double y, double vx, double vy, int left, double best) {
    double px = x - e->ax, py = y - e->ay;
    double d = px * e->nx + py * e->ny, w = vx * e->nx + vy * e->ny, g = -FALLS * e->ny;
    if (left ? w < 0 : d < 0) { d = -d; w = -w; g = -g; }
    double t = fall(0.5 * g, w, d - r, left);
    if (t >= best) return INFINITY;
    double u = px * e->tx + py * e->ty + t * (vx * e->tx + vy * e->ty - 0.5 * t * FALLS * e->ty);
    return u >= -1e-9 && u <= e->length + 1e-9 ? t : INFINITY;
}

/* First root of |p + v t + g t^2 / 2|^2 - r^2 before best: where its box may touch, between the turns of the quartic. */
static double vertex_time(const Vertex *v, double x, double y, double vx, double vy, int left, double best) {
    if (left) return INFINITY;
    double px = x - v->x, py = y - v->y, end = px + best * vx, foot = py + best * (vy - 0.5 * best * FALLS);
    double top = vy > 0 && vy < best * FALLS ? py + 0.5 * vy * vy / FALLS : fmax(py, foot);
    if (fmin(px, end) > r || fmax(px, end) < -r || top < -r || fmin(py, foot) > r) return INFINITY;
    double a = FALLS * FALLS / 4, b = -vy * FALLS, c = vx * vx + vy * vy - py * FALLS, d = 2 * (px * vx + py * vy);
    double f = px * px + py * py - r * r, m = -b / (4 * a), p = c / (2 * a) - 3 * m * m;
    double q = d / (4 * a) + m * (c / (2 * a) - 2 * m * m), turns[3], h = q * q / 4 + p * p * p / 27;
    int count = 0;
    if (h > 0) {
        double s = sqrt(h);
        turns[count++] = m + cbrt(-q / 2 + s) + cbrt(-q / 2 - s);
    } else {
        double s = 2 * sqrt(-p / 3), angle = acos(fmax(-1, fmin(1, 3 * q / (p * s)))) / 3;
        for (int k = 2; k >= 0; k--) turns[count++] = m + s * cos(angle - 2 * M_PI * k / 3);
        for (int i = 0; i < 2; i++)
            for (int k = 0; k < 2 - i; k++)
                if (turns[k] > turns[k + 1]) { double one = turns[k]; turns[k] = turns[k + 1], turns[k + 1] = one; }
    }
    double low = 0;
    for (int k = 0; k < count; k += 2) { /* f falls up to the first and the third turn */
        double high = fmin(turns[k], best);
        if (k == 2) low = fmax(turns[1], 0);
        if (high <= low || (((a * high + b) * high + c) * high + d) * high + f > 0) continue;
        for (int n = 0; n < 60; n++) {
            double t = (low + high) / 2;
            for (int newton = 0; newton < 8; newton++) {
                double value = (((a * t + b) * t + c) * t + d) * t + f, slope = ((4 * a * t + 3 * b) * t + 2 * c) * t + d;
                double step = value / slope;
                if (value > 0) low = t;
                else high = t;
                if (fabs(step) <= 1e-15 * t) return t;
                t -= step;
                if (!(t > low && t < high)) break;
            }
        }
        return low;
    }
    return INFINITY;
}
#else
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
#endif

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

#ifdef FALLS
/* How long a coordinate p with velocity v takes to leave what lies between low and high. */
static double leaves(double p, double v, double g, double low, double high, int *side) {
    double up = g > 0 ? (v > 0 && v * v > 2 * g * (high - p) ? 2 * (high - p) / (v + sqrt(v * v - 2 * g * (high - p))) : INFINITY)
                      : (v > 0 ? (high - p) / v : INFINITY);
    double down = g > 0 ? (v + sqrt(v * v + 2 * g * fmax(p - low, 0))) / g : (v < 0 ? (low - p) / v : INFINITY);
    *side = up < down ? 1 : -1;
    return fmax(fmin(up, down), 0);
}

static int search(double x, double y, double vx, double vy, int last, double *best) {
    int i = place(x - x_low, columns), j = place(y - y_low, rows), hit = -1, step_i, step_j;
    double now = 0;
    while ((unsigned)i < (unsigned)columns && (unsigned)j < (unsigned)rows) {
        int c = j * columns + i;
        for (int k = start[c]; k < start[c + 1]; k++) {
            int one = listed[k];
            double t = one < edges ? edge_time(&e[one], x, y, vx, vy, one == last, *best)
                                   : vertex_time(&v[one - edges], x, y, vx, vy, one == last, *best);
            if (t < *best) *best = t, hit = one;
        }
        double px = x + now * vx, py = y + now * (vy - 0.5 * now * FALLS), left = x_low + i * cell, low = y_low + j * cell;
        double after_i = leaves(px, vx, 0, left, left + cell, &step_i);
        double after_j = leaves(py, vy - now * FALLS, FALLS, low, low + cell, &step_j), after = fmin(after_i, after_j);
        if (*best <= now + after) break;
        now += after;
        if (after_i < after_j) i += step_i;
        else j += step_j;
    }
    return hit;
}
#else
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
#endif

static long fly(double *b) {
    double x = b[0], y = b[1], vx = b[2], vy = b[3], left = until;
    long bounces = 0;
    for (int last = -1;; bounces++) {
        double best = left, nx, ny;
        int hit = search(x, y, vx, vy, last, &best);
        x += best * vx, y += best * vy, left -= best;
#ifdef FALLS
        y -= 0.5 * best * best * FALLS, vy -= best * FALLS;
#endif
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
