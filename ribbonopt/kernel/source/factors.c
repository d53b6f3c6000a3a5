/* Factors of a chain's Newton matrix: elements reduced to their nodes, nodes merged one after the
 * other by orthogonal elimination (stable for growing and decaying modes alike, Wright 1992), the
 * few that are left, the constants and the conditions by LU. */
#include "kernel.h"

#include <math.h>
#include <string.h>

int chain_last(const Chain *s)
{
    return (s->phases + 1) * s->nx + s->nc;
}

Factors *factors_new(const Chain *s, int only)
{
    Factors *f = allocate(1, sizeof(Factors));
    if (!f)
        return NULL;
    size_t N = s->N, n = (size_t)s->K * (s->nv - s->nr), last = chain_last(s);
    size_t elements = only ? 1 : N, columns = 3 * s->nx + s->nc;
    f->only = only;
    f->h_jacobians = allocate(N * s->K * s->ne * s->nv, sizeof(double));
    f->lu = allocate(elements * n * n, sizeof(double));
    f->pivots = allocate(elements * n, sizeof(int));
    f->by_ends = allocate(N * s->K * s->nv * (s->nx + s->nc), sizeof(double));
    f->shares = only ? allocate(N * s->K * s->nv, sizeof(double)) : NULL;
    f->merges = allocate(N * 2 * s->nx * columns, sizeof(double));
    f->scales = allocate(N * s->nx, sizeof(double));
    f->last = allocate(last * last, sizeof(double));
    f->last_pivots = allocate(last, sizeof(int));
    if (f->h_jacobians && f->lu && f->pivots && f->by_ends && (f->shares || !only) && f->merges &&
        f->scales && f->last && f->last_pivots)
        return f;
    factors_free(f);
    return NULL;
}

void factors_free(Factors *f)
{
    if (!f)
        return;
    release(f->h_jacobians);
    release(f->lu);
    release(f->pivots);
    release(f->by_ends);
    release(f->shares);
    release(f->merges);
    release(f->scales);
    release(f->last);
    release(f->last_pivots);
    release(f);
}

static void count_pivot(Factors *f, double pivot)
{
    f->sign = pivot < 0 ? -f->sign : f->sign;
    f->log += log(fabs(pivot));
}

/* Put the relation of one element behind those before it, which end at its first node. */
static int merge(Factors *f, const Chain *s, int e, const double *relation, double *before,
                 double *sums)
{
    int nx = s->nx, own = nx + s->nc, columns = 3 * nx + s->nc;
    double *matrix = f->merges + (size_t)e * 2 * nx * columns;
    double *const left = before, *right = left + nx * nx, *constants = right + nx * nx;
    memset(matrix, 0, (size_t)2 * nx * columns * sizeof(double));
    for (int k = 0; k < nx; k++) { /* columns: node between, first, last, constants */
        double *top = matrix + (size_t)k * columns, *bottom = top + (size_t)nx * columns;
        memcpy(top, right + k * nx, nx * sizeof(double));
        memcpy(top + nx, left + k * nx, nx * sizeof(double));
        memcpy(top + 3 * nx, constants + k * s->nc, s->nc * sizeof(double));
        memcpy(bottom, relation + (size_t)k * own, nx * sizeof(double));
        bottom[2 * nx + k] = 1.0;
        memcpy(bottom + 3 * nx, relation + (size_t)k * own + nx, s->nc * sizeof(double));
    }
    if (qr_factor(matrix, f->scales + (size_t)e * nx, 2 * nx, nx, columns, sums, &f->sign))
        return -1;
    for (int k = 0; k < nx; k++) {
        const double *row = matrix + (size_t)(nx + k) * columns;
        memcpy(left + k * nx, row + nx, nx * sizeof(double));
        memcpy(right + k * nx, row + 2 * nx, nx * sizeof(double));
        memcpy(constants + k * s->nc, row + 3 * nx, s->nc * sizeof(double));
        count_pivot(f, matrix[(size_t)k * columns + k]);
    }
    return 0;
}

/* Rows of what is left of a phase in the last system: first node, last node, constants. */
static void fill_last(Factors *f, const Chain *s, int phase, const double *before)
{
    int nx = s->nx, size = chain_last(s);
    const double *left = before, *right = left + nx * nx, *constants = right + nx * nx;
    for (int k = 0; k < nx; k++) {
        double *row = f->last + (size_t)(phase * nx + k) * size;
        memcpy(row + phase * nx, left + k * nx, nx * sizeof(double));
        memcpy(row + (phase + 1) * nx, right + k * nx, nx * sizeof(double));
        memcpy(row + size - s->nc, constants + k * s->nc, s->nc * sizeof(double));
    }
}

static int make(Factors *f, const Chain *s, const double *jacobians,
                const double *condition_jacobian, const double *widths, const double *residuals,
                double *before, double *relation, double *scratch)
{
    int nx = s->nx, own = nx + s->nc, size = chain_last(s), n = s->K * (s->nv - s->nr);
    size_t nn = (size_t)n * n, per_jacobian = (size_t)s->K * s->ne;
    f->log = 0.0;
    f->sign = nx * s->phases % 2 ? -1 : 1;
    memset(f->last, 0, (size_t)size * size * sizeof(double));
    for (int phase = 0; phase < s->phases; phase++) {
        for (int e = s->ends[phase]; e < s->ends[phase + 1]; e++) {
            double *lu = f->lu + (f->only ? 0 : e * nn), *J = f->h_jacobians;
            int *pivots = f->pivots + (f->only ? 0 : (size_t)e * n);
            J += (size_t)e * per_jacobian * s->nv;
            if (element_factor(s, jacobians + e * per_jacobian * (s->nv + s->nc), widths[e], J, lu,
                               pivots, f->by_ends + (size_t)e * s->K * s->nv * own, relation,
                               scratch))
                return -1;
            if (f->only)
                element_share(s, J, lu, pivots, residuals + (size_t)e * s->element_equations,
                              f->shares + (size_t)e * s->K * s->nv, scratch);
            if (e > s->ends[phase]) {
                if (merge(f, s, e, relation, before, scratch))
                    return -1;
                continue;
            }
            memset(before, 0, (size_t)nx * (2 * nx + s->nc) * sizeof(double));
            for (int k = 0; k < nx; k++) {
                memcpy(before + k * nx, relation + (size_t)k * own, nx * sizeof(double));
                before[nx * nx + k * nx + k] = 1.0;
                memcpy(before + 2 * nx * nx + k * s->nc, relation + (size_t)k * own + nx,
                       s->nc * sizeof(double));
            }
        }
        fill_last(f, s, phase, before);
    }
    for (int k = 0; k < s->nb; k++)
        for (int c = 0; c < size; c++)
            f->last[(size_t)(s->phases * nx + k) * size + c] = condition_jacobian[c * s->nb + k];
    if (lu_factor(f->last, f->last_pivots, size))
        return -1;
    for (int k = 0; k < size; k++) {
        count_pivot(f, f->last[(size_t)k * size + k]);
        f->sign = f->last_pivots[k] != k ? -f->sign : f->sign;
    }
    return 0;
}

int factors_make(Factors *f, const Chain *s, const double *jacobians,
                 const double *condition_jacobian, const double *widths, const double *residuals)
{
    size_t own = s->nx + s->nc, columns = 3 * s->nx + s->nc;
    size_t size = element_scratch(s) + columns;
    double *scratch = allocate(size + s->nx * (own + columns), sizeof(double));
    if (!scratch)
        return -2;
    double *relation = scratch + size, *before = relation + s->nx * own;
    int failed = make(f, s, jacobians, condition_jacobian, widths, residuals, before, relation,
                      scratch);
    release(scratch);
    return failed;
}

/* Nodes between the ends of a phase, which are known: R x_e = u_e - left x_first - ... */
static void expand_nodes(const Factors *f, const Chain *s, int phase, const double *eliminated,
                         double *step)
{
    int nx = s->nx, columns = 3 * nx + s->nc;
    const double *first = step + (size_t)s->ends[phase] * s->element_unknowns;
    const double *constants = step + s->unknowns - s->nc;
    for (int e = s->ends[phase + 1] - 1; e > s->ends[phase]; e--) {
        double *x = step + (size_t)e * s->element_unknowns;
        const double *matrix = f->merges + (size_t)e * 2 * nx * columns;
        const double *next = x + s->element_unknowns;
        for (int k = nx - 1; k >= 0; k--) {
            const double *row = matrix + (size_t)k * columns;
            double sum = eliminated[(size_t)e * nx + k];
            for (int j = 0; j < nx; j++)
                sum -= row[nx + j] * first[j] + row[2 * nx + j] * next[j];
            for (int j = 0; j < s->nc; j++)
                sum -= row[3 * nx + j] * constants[j];
            for (int j = k + 1; j < nx; j++)
                sum -= row[j] * x[j];
            x[k] = sum / row[k];
        }
    }
}

int factors_solve(const Factors *f, const Chain *s, const double *residuals, double *step)
{
    int nx = s->nx, size = chain_last(s), n = s->K * (s->nv - s->nr), columns = 3 * nx + s->nc;
    size_t stages = (size_t)s->K * s->nv, per_jacobian = (size_t)s->K * s->ne * s->nv;
    double *eliminated = allocate((size_t)s->N * nx + 2 * nx + size + element_scratch(s),
                                  sizeof(double));
    if (!eliminated)
        return -2;
    double *pair = eliminated + (size_t)s->N * nx, *last = pair + 2 * nx, *scratch = last + size;
    for (int phase = 0; phase < s->phases; phase++) {
        for (int e = s->ends[phase]; e < s->ends[phase + 1]; e++) {
            const double *own = residuals + (size_t)e * s->element_equations;
            const double *J = f->h_jacobians + e * per_jacobian;
            double *share = step + (size_t)e * s->element_unknowns + nx;
            double *right = e == s->ends[phase] ? pair : pair + nx;
            if (f->only)
                memcpy(share, f->shares + e * stages, stages * sizeof(double));
            else
                element_share(s, J, f->lu + (size_t)e * n * n, f->pivots + (size_t)e * n, own,
                              share, scratch);
            element_step(s, J, own, share, right);
            if (e == s->ends[phase])
                continue;
            qr_apply(f->merges + (size_t)e * 2 * nx * columns, f->scales + (size_t)e * nx, 2 * nx,
                     nx, columns, pair);
            memcpy(eliminated + (size_t)e * nx, pair, nx * sizeof(double));
            memcpy(pair, pair + nx, nx * sizeof(double));
        }
        memcpy(last + phase * nx, pair, nx * sizeof(double));
    }
    const double *conditions = residuals + (size_t)s->N * s->element_equations;
    for (int k = 0; k < s->nb; k++)
        last[s->phases * nx + k] = -conditions[k];
    lu_solve(f->last, f->last_pivots, size, last, 1);
    for (int i = 0; i <= s->phases; i++)
        memcpy(step + (size_t)s->ends[i] * s->element_unknowns, last + i * nx,
               nx * sizeof(double));
    double *constants = step + s->unknowns - s->nc;
    memcpy(constants, last + size - s->nc, s->nc * sizeof(double));
    for (int phase = 0; phase < s->phases; phase++)
        expand_nodes(f, s, phase, eliminated, step);
    for (int e = 0; e < s->N; e++) {
        const double *by = f->by_ends + e * stages * (nx + s->nc);
        double *first = step + (size_t)e * s->element_unknowns, *stage = first + nx;
        for (size_t k = 0; k < stages; k++, by += nx + s->nc) {
            stage[k] += dot(by, first, nx) + dot(by + nx, constants, s->nc);
        }
    }
    release(eliminated);
    return 0;
}
