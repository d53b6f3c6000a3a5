/* Writhe of a closed polygon, exactly: see ribbonopt.checks.polygons, which has the sources. */
#include "kernel.h"

#include <math.h>

static void cross(const double *u, const double *v, double *w)
{
    w[0] = u[1] * v[2] - u[2] * v[1];
    w[1] = u[2] * v[0] - u[0] * v[2];
    w[2] = u[0] * v[1] - u[1] * v[0];
}

static double inner(const double *u, const double *v)
{
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

/* Signed area of the directions from which segment a b is seen to cross c d. */
static double seen_area(const double *a, const double *b, const double *c, const double *d)
{
    double sides[4][3], lengths[4], own[3], other[3], along[3], area = 0.0;
    for (int k = 0; k < 3; k++) {
        sides[0][k] = c[k] - a[k];
        sides[1][k] = d[k] - a[k];
        sides[2][k] = d[k] - b[k];
        sides[3][k] = c[k] - b[k];
        own[k] = b[k] - a[k];
        other[k] = d[k] - c[k];
    }
    cross(other, own, along);
    double side = inner(along, sides[0]);
    if (side == 0.0)
        return 0.0;
    for (int i = 0; i < 4; i++)
        lengths[i] = sqrt(inner(sides[i], sides[i]));
    /* Two triangles on the sphere, after Van Oosterom and Strackee (1983). */
    for (int i = 1; i < 3; i++) {
        const double *u = sides[0], *v = sides[i], *w = sides[i + 1];
        double lu = lengths[0], lv = lengths[i], lw = lengths[i + 1], normal[3];
        cross(v, w, normal);
        area += 2.0 * atan2(inner(u, normal), lu * lv * lw + inner(u, v) * lw + inner(u, w) * lv +
                                                  inner(v, w) * lu);
    }
    return side != side ? side : copysign(fabs(area), side);
}

double writhe(const double *r, long count)
{
    double sum = 0.0;
    for (long i = 0; i < count; i++) {
        const double *a = r + 3 * i, *b = r + 3 * ((i + 1) % count);
        for (long j = i + 2; j < count - (i == 0); j++)
            sum += seen_area(a, b, r + 3 * j, r + 3 * ((j + 1) % count));
    }
    return sum / (2.0 * 3.14159265358979323846);
}
