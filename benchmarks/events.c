/* A plain event loop to measure against: one disc or point after the other, every edge and vertex asked each time.
   Input on stdin: edges, balls, time, radius; then ax ay bx by an edge; then x y vx vy a ball. Output: bounces seconds. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct { double ax, ay, tx, ty, nx, ny, length; } Edge;

static double edge_time(const Edge *e, double x, double y, double vx, double vy, double r) {
    double px = x - e->ax, py = y - e->ay;
    double d = px * e->nx + py * e->ny, v = vx * e->nx + vy * e->ny;
    if (d < 0) { d = -d; v = -v; }
    if (v >= 0) return INFINITY;
    double t = (d - r) / -v;
    if (t < 0) t = 0;
    double u = px * e->tx + py * e->ty + t * (vx * e->tx + vy * e->ty);
    return u >= 0 && u <= e->length ? t : INFINITY;
}

static double vertex_time(const Edge *e, double x, double y, double vx, double vy, double r) {
    double px = x - e->ax, py = y - e->ay, along = px * vx + py * vy, square = vx * vx + vy * vy;
    if (along >= 0) return INFINITY;
    double cross = px * vy - py * vx, left = r * r - cross * cross / square;
    if (left < 0) return INFINITY;
    double t = (px * px + py * py - r * r) / (sqrt(square * left) - along);
    return t > 0 ? t : 0;
}

int main(void) {
    int edges, balls;
    double until, r;
    if (scanf("%d %d %lf %lf", &edges, &balls, &until, &r) != 4) return 2;
    Edge *e = malloc(edges * sizeof *e);
    double (*b)[4] = malloc(balls * sizeof *b);
    for (int i = 0; i < edges; i++) {
        double bx, by;
        if (scanf("%lf %lf %lf %lf", &e[i].ax, &e[i].ay, &bx, &by) != 4) return 2;
        e[i].length = hypot(bx - e[i].ax, by - e[i].ay);
        e[i].tx = (bx - e[i].ax) / e[i].length, e[i].ty = (by - e[i].ay) / e[i].length;
        e[i].nx = e[i].ty, e[i].ny = -e[i].tx;
    }
    for (int i = 0; i < balls; i++)
        if (scanf("%lf %lf %lf %lf", &b[i][0], &b[i][1], &b[i][2], &b[i][3]) != 4) return 2;
    clock_t begin = clock();
    long bounces = 0;
    for (int i = 0; i < balls; i++) {
        double x = b[i][0], y = b[i][1], vx = b[i][2], vy = b[i][3], left = until;
        int last = -1;
        for (;;) {
            double best = left, nx = 0, ny = 0;
            int hit = -1;
            for (int k = 0; k < edges; k++) {
                if (k != last) {
                    double t = edge_time(&e[k], x, y, vx, vy, r);
                    if (t < best) best = t, hit = k;
                }
                if (r > 0 && k + edges != last) {
                    double t = vertex_time(&e[k], x, y, vx, vy, r);
                    if (t < best) best = t, hit = k + edges;
                }
            }
            x += best * vx, y += best * vy, left -= best;
            if (hit < 0) break;
            if (hit < edges) nx = e[hit].nx, ny = e[hit].ny;
            else nx = x - e[hit - edges].ax, ny = y - e[hit - edges].ay;
            double k = 2 * (vx * nx + vy * ny) / (nx * nx + ny * ny);
            vx -= k * nx, vy -= k * ny, last = hit, bounces++;
        }
        b[i][0] = x;
    }
    double sum = 0;
    for (int i = 0; i < balls; i++) sum += b[i][0];
    printf("%ld %.9g %.3g\n", bounces, (double)(clock() - begin) / CLOCKS_PER_SEC, sum);
    return 0;
}
