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

/* y += factor * x */
static void add(double *y, const double *x, double factor, int n)
{
    INDEPENDENT for (int i = 0; i < n; i++) y[i] += factor * x[i];
}

/* The matrix of q (K nq, K nq), from h J (K, ne, nv); `through` (K, nr, K nq) and `rows` (K nq, K
 * nq) are scratch. */
static void fill_matrix(const Chain *s, const double *J, double *matrix, double *through,
                        double *rows)
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
            for (int k = 0; k < s->nr; k++)
                if (own[s->r[k]] != 0.0)
                    add(row, through + (l * s->nr + k) * n, own[s->r[k]], n);
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
 * derivatives by other things, `direct` (K, ne, columns) or none, put on their right-hand sides. */
static void add_others(const Chain *s, const double *J, const double *fixed, const double *direct,
                       int columns, double *sum, double *right)
{
    int K = s->K, nq = s->nv - s->nr;
    for (int j = 0; j < K; j++)
        for (int a = 0; a < nq; a++) {
            int row = equation_of(s, a);
            for (int c = 0; c < columns; c++)
                sum[c] = direct ? direct[((size_t)j * s->ne + row) * columns + c] : 0.0;
            for (int k = 0; k < s->nr; k++) {
                double factor = J[((size_t)j * s->ne + row) * s->nv + s->r[k]];
                const double *x = fixed + (size_t)(j * s->nr + k) * columns;
                if (factor != 0.0)
                    add(sum, x, factor, columns);
            }
            for (int i = 0; i < K; i++) {
                double factor = a < s->held ? s->a[i * K + j] : i == j ? -1.0 : 0.0;
                double *target = right + (size_t)(i * nq + a) * columns;
                if (factor != 0.0)
                    add(target, sum, factor, columns);
            }
        }
}

/* All unknowns of the stages (K, nv, columns): q as they are, r = fixed + sum_j a_ij h J_rq q. */
static void fill_stages(const Chain *s, const double *J, const double *q, const double *fixed,
                        int columns, double *sum, double *stages)
{
    int K = s->K, nq = s->nv - s->nr;
    size_t row = columns;
    for (int i = 0; i < K; i++) {
        for (int b = 0; b < nq; b++)
            memcpy(stages + (i * s->nv + s->q[b]) * row, q + (i * nq + b) * row,
                   row * sizeof(double));
        for (int k = 0; k < s->nr; k++)
            memcpy(stages + (i * s->nv + s->r[k]) * row, fixed + (i * s->nr + k) * row,
                   row * sizeof(double));
    }
    for (int j = 0; j < K; j++)
        for (int k = 0; k < s->nr; k++) {
            memset(sum, 0, row * sizeof(double));
            for (int b = 0; b < nq; b++) {
                double factor = J[((size_t)j * s->ne + s->r[k]) * s->nv + s->q[b]];
                const double *x = q + (j * nq + b) * row;
                if (factor != 0.0)
                    add(sum, x, factor, columns);
            }
            for (int i = 0; i < K; i++) {
                double factor = s->a[i * K + j], *target = stages + (i * s->nv + s->r[k]) * row;
                add(target, sum, factor, columns);
            }
        }
}

/* What the stages (K, nv, columns) add to the step of the states: sum_j b_j h J_j (nx, columns). */
static void add_steps(const Chain *s, const double *J, const double *stages, int columns,
                      double *steps)
{
    for (int j = 0; j < s->K; j++)
        for (int k = 0; k < s->nx; k++)
            for (int v = 0; v < s->nv; v++) {
                double factor = s->b[j] * J[((size_t)j * s->ne + k) * s->nv + v];
                const double *x = stages + (size_t)(j * s->nv + v) * columns;
                double *target = steps + (size_t)k * columns;
                if (factor != 0.0)
                    add(target, x, factor, columns);
            }
}

size_t element_scratch(const Chain *s)
{
    size_t columns = s->nx + s->nc, K = s->K, n = K * (s->nv - s->nr);
    return K * (s->ne + s->nv + s->nr) * columns + columns + K * s->nr * n + n * n + 2 * K * s->nv;
}

int element_factor(const Chain *s, const double *jacobians, double h, double *J, double *lu,
                   int *pivots, double *by_ends, double *relation, double *scratch)
{
    int K = s->K, nq = s->nv - s->nr, columns = s->nx + s->nc;
    double *direct = scratch, *right = direct + (size_t)K * s->ne * columns;
    double *fixed = right + (size_t)K * s->nv * columns, *sum = fixed + (size_t)K * s->nr * columns;
    memset(direct, 0, (size_t)(sum - direct) * sizeof(double));
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
    double *through = sum + columns;
    fill_matrix(s, J, lu, through, through + (size_t)K * s->nr * K * nq);
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
    add_others(s, J, fixed, direct, columns, sum, right);
    lu_solve(lu, pivots, K * nq, right, columns);
    fill_stages(s, J, right, fixed, columns, sum, by_ends);
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

void element_share(const Chain *s, const double *J, const double *lu, const int *pivots,
                   const double *residuals, double *share, double *scratch)
{
    int K = s->K, nq = s->nv - s->nr;
    double *q = scratch, *fixed = q + K * s->nv, sum;
    for (int i = 0; i < K; i++) {
        for (int a = 0; a < nq; a++)
            q[i * nq + a] = -residuals[i * s->ne + equation_of(s, a)];
        for (int k = 0; k < s->nr; k++)
            fixed[i * s->nr + k] = -residuals[i * s->ne + s->r[k]];
    }
    add_others(s, J, fixed, NULL, 1, &sum, q);
    lu_solve(lu, pivots, K * nq, q, 1);
    fill_stages(s, J, q, fixed, 1, &sum, share);
}

void element_step(const Chain *s, const double *J, const double *residuals, const double *share,
                  double *right)
{
    for (int k = 0; k < s->nx; k++)
        right[k] = -residuals[s->K * s->ne + k];
    add_steps(s, J, share, 1, right);
}
