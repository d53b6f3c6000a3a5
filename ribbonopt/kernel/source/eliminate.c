/* One element reduced to its two nodes: the stages' unknowns solved for.
 *
 * With x_i = x_0 + sum_j a_ij h F_j, states r whose F holds no other of them (J_rr = 0) are put into
 * the equations of the others, q, exactly; what is factored has K unknowns less for each of them.
 * The variables of an algebraic equation are always in q. */
#include "kernel.h"

#include <string.h>

/* The index in a stage's equations of the one that stands for unknown number b of q. */
static int equation_of(const Chain *s, int b)
{
    return b < s->held ? s->q[b] : s->nx + b - s->held;
}

/* Entries of a row of h J by some unknowns. */
static void gather(const double *row, const int *unknowns, int count, double *entries)
{
    for (int k = 0; k < count; k++)
        entries[k] = row[unknowns[k]];
}

/* The matrix of q (K nq, K nq), from h J (K, ne, nv); `entries` (nv,), `through` (K, nr, K
 * nq) and `rows` (K nq, K nq) are scratch. */
static void fill_matrix(const Chain *s, const double *J, double *matrix, double *entries,
                        double *through, double *rows)
{
    int K = s->K, nq = s->nv - s->nr, n = K * nq;
    for (int l = 0; l < K; l++) /* r of stage l by all q: a_lj J_rq,j */
        for (int k = 0; k < s->nr; k++)
            for (int j = 0; j < K; j++)
                for (int b = 0; b < nq; b++)
                    through[(l * s->nr + k) * n + j * nq + b] =
                        s->a[l * K + j] * J[((size_t)j * s->ne + s->r[k]) * s->nv + s->q[b]];
    for (int l = 0; l < K; l++) /* F and g of stage l by all q */
        for (int a = 0; a < nq; a++) {
            const double *own = J + ((size_t)l * s->ne + equation_of(s, a)) * s->nv;
            double *row = rows + (size_t)(l * nq + a) * n;
            memset(row, 0, n * sizeof(double));
            for (int b = 0; b < nq; b++)
                row[l * nq + b] = own[s->q[b]];
            gather(own, s->r, s->nr, entries);
            add_rows(row, through + (size_t)l * s->nr * n, n, entries, 1, s->nr, 1.0, n);
        }
    memset(matrix, 0, (size_t)n * n * sizeof(double));
    for (int i = 0; i < K; i++)
        for (int a = 0; a < nq; a++) {
            double *target = matrix + (size_t)(i * nq + a) * n;
            if (a >= s->held) {
                memcpy(target, rows + (size_t)(i * nq + a) * n, n * sizeof(double));
                continue;
            }
            target[i * nq + a] = 1.0;
            add_rows(target, rows + (size_t)a * n, (size_t)nq * n, s->a + i * K, 1, K, -1.0, n);
        }
}

/* Add to the equations of q (K nq, columns) what r, held at `fixed` (K, nr, columns), and the
 * derivatives by other things, `direct` (K, ne, columns), put on their right-hand sides. */
static void add_others(const Chain *s, const double *J, const double *fixed, const double *direct,
                       int columns, double *entries, double *sums, double *right)
{
    int K = s->K, nq = s->nv - s->nr;
    const size_t c = columns;
    for (int j = 0; j < K; j++)
        for (int a = 0; a < nq; a++) {
            size_t row = (size_t)j * s->ne + equation_of(s, a);
            double *sum = sums + (j * nq + a) * c;
            memcpy(sum, direct + row * c, c * sizeof(double));
            gather(J + row * s->nv, s->r, s->nr, entries);
            add_rows(sum, fixed + j * s->nr * c, c, entries, 1, s->nr, 1.0, columns);
        }
    for (int i = 0; i < K; i++)
        for (int a = 0; a < nq; a++) {
            double *target = right + (i * nq + a) * c;
            if (a < s->held)
                add_rows(target, sums + a * c, nq * c, s->a + i * K, 1, K, 1.0, columns);
            else
                for (int k = 0; k < columns; k++)
                    target[k] -= sums[(i * nq + a) * c + k];
        }
}

/* All unknowns of the stages (K, nv, columns): q as they are, r = fixed + sum_j a_ij h J_rq q. */
static void fill_stages(const Chain *s, const double *J, const double *q, const double *fixed,
                        int columns, double *entries, double *sums, double *stages)
{
    int K = s->K, nq = s->nv - s->nr;
    const size_t c = columns;
    for (int j = 0; j < K; j++)
        for (int k = 0; k < s->nr; k++) {
            double *sum = sums + (j * s->nr + k) * c;
            memset(sum, 0, c * sizeof(double));
            gather(J + ((size_t)j * s->ne + s->r[k]) * s->nv, s->q, nq, entries);
            add_rows(sum, q + j * nq * c, c, entries, 1, nq, 1.0, columns);
        }
    for (int i = 0; i < K; i++) {
        for (int b = 0; b < nq; b++)
            memcpy(stages + (i * s->nv + s->q[b]) * c, q + (i * nq + b) * c, c * sizeof(double));
        for (int k = 0; k < s->nr; k++) {
            double *target = stages + (i * s->nv + s->r[k]) * c;
            memcpy(target, fixed + (i * s->nr + k) * c, c * sizeof(double));
            add_rows(target, sums + k * c, s->nr * c, s->a + i * K, 1, K, 1.0, columns);
        }
    }
}

/* What the stages (K, nv, columns) add to the step of the states: sum_j b_j h J_j (nx, columns). */
static void add_steps(const Chain *s, const double *J, const double *stages, int columns,
                      double *steps)
{
    for (int j = 0; j < s->K; j++)
        for (int k = 0; k < s->nx; k++)
            add_rows(steps + (size_t)k * columns, stages + (size_t)j * s->nv * columns, columns,
                     J + ((size_t)j * s->ne + k) * s->nv, 1, s->nv, s->b[j], columns);
}

size_t element_scratch(const Chain *s)
{
    size_t columns = s->nx + s->nc, K = s->K, n = K * (s->nv - s->nr);
    return K * (s->ne + 2 * s->nv + s->nr) * columns + s->nv + K * s->nr * n + n * n + 2 * K * s->nv;
}

int element_factor(const Chain *s, const double *jacobians, double h, double *J, double *lu,
                   int *pivots, double *by_ends, double *relation, double *scratch)
{
    int K = s->K, nq = s->nv - s->nr, columns = s->nx + s->nc;
    double *direct = scratch, *right = direct + (size_t)K * s->ne * columns;
    double *fixed = right + (size_t)K * s->nv * columns;
    double *sums = fixed + (size_t)K * s->nr * columns;
    memset(direct, 0, (size_t)(sums - direct) * sizeof(double));
    for (int j = 0; j < K; j++)
        for (int e = 0; e < s->ne; e++) {
            const double *source = jacobians + (size_t)j * s->ne * (s->nv + s->nc) + e;
            size_t row = (size_t)j * s->ne + e;
            double scale = e < s->nx ? h : 1.0;
            for (int v = 0; v < s->nv; v++)
                J[row * s->nv + v] = scale * source[(size_t)v * s->ne];
            for (int c = 0; c < s->nc; c++)
                direct[row * columns + s->nx + c] = scale * source[(size_t)(s->nv + c) * s->ne];
        }
    double *entries = sums + (size_t)K * s->nv * columns, *through = entries + s->nv;
    fill_matrix(s, J, lu, entries, through, through + (size_t)K * s->nr * K * nq);
    if (lu_factor(lu, pivots, K * nq))
        return -1;
    for (int i = 0; i < K; i++) {
        for (int a = 0; a < s->held; a++)
            right[(size_t)(i * nq + a) * columns + s->q[a]] = 1.0;
        for (int k = 0; k < s->nr; k++) {
            double *row = fixed + (size_t)(i * s->nr + k) * columns;
            row[s->r[k]] = 1.0;
            for (int j = 0; j < K; j++)
                for (int c = s->nx; c < columns; c++)
                    row[c] += s->a[i * K + j] *
                              direct[((size_t)j * s->ne + s->r[k]) * columns + c];
        }
    }
    add_others(s, J, fixed, direct, columns, entries, sums, right);
    lu_solve(lu, pivots, K * nq, right, columns);
    fill_stages(s, J, right, fixed, columns, entries, sums, by_ends);
    memset(relation, 0, (size_t)s->nx * columns * sizeof(double));
    for (int k = 0; k < s->nx; k++) {
        relation[(size_t)k * columns + k] = 1.0;
        for (int j = 0; j < K; j++)
            for (int c = s->nx; c < columns; c++)
                relation[(size_t)k * columns + c] +=
                    s->b[j] * direct[((size_t)j * s->ne + k) * columns + c];
    }
    add_steps(s, J, by_ends, columns, relation);
    for (int k = 0; k < s->nx * columns; k++)
        relation[k] = -relation[k];
    return 0;
}

/* As add_others and fill_stages do for many columns, for the one of a residual. */
void element_share(const Chain *s, const double *J, const double *lu, const int *pivots,
                   const double *residuals, double *share, double *scratch)
{
    int K = s->K, nq = s->nv - s->nr, nr = s->nr, held = s->held;
    double *q = scratch, *fixed = q + K * nq, *sum = fixed + K * nr;
    for (int i = 0; i < K; i++) {
        for (int a = 0; a < nq; a++)
            q[i * nq + a] = -residuals[i * s->ne + equation_of(s, a)];
        for (int k = 0; k < nr; k++)
            fixed[i * nr + k] = -residuals[i * s->ne + s->r[k]];
    }
    for (int j = 0; j < K; j++) {
        for (int a = 0; a < nq; a++) {
            const double *row = J + ((size_t)j * s->ne + equation_of(s, a)) * s->nv;
            sum[a] = 0.0;
            for (int k = 0; k < nr; k++)
                sum[a] += row[s->r[k]] * fixed[j * nr + k];
        }
        for (int i = 0; i < K; i++)
            for (int a = 0; a < held; a++)
                q[i * nq + a] += s->a[i * K + j] * sum[a];
        for (int a = held; a < nq; a++)
            q[j * nq + a] -= sum[a];
    }
    lu_solve(lu, pivots, K * nq, q, 1);
    for (int j = 0; j < K; j++) {
        for (int k = 0; k < nr; k++) {
            const double *row = J + ((size_t)j * s->ne + s->r[k]) * s->nv;
            sum[k] = 0.0;
            for (int b = 0; b < nq; b++)
                sum[k] += row[s->q[b]] * q[j * nq + b];
        }
        for (int i = 0; i < K; i++)
            for (int k = 0; k < nr; k++)
                fixed[i * nr + k] += s->a[i * K + j] * sum[k];
    }
    for (int i = 0; i < K; i++) {
        for (int b = 0; b < nq; b++)
            share[i * s->nv + s->q[b]] = q[i * nq + b];
        for (int k = 0; k < nr; k++)
            share[i * s->nv + s->r[k]] = fixed[i * nr + k];
    }
}

void element_step(const Chain *s, const double *J, const double *residuals, const double *share,
                  double *right)
{
    for (int k = 0; k < s->nx; k++) {
        double sum = -residuals[s->K * s->ne + k];
        for (int j = 0; j < s->K; j++)
            sum += s->b[j] * dot(J + ((size_t)j * s->ne + k) * s->nv, share + j * s->nv, s->nv);
        right[k] = sum;
    }
}
