/* Small dense matrices, stored by rows. */
#include "kernel.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define PANEL 4 /* columns of a matrix that are eliminated together */

void add_rows(double *y, const double *x, size_t stride, const double *factors, size_t step,
              int count, double sign, int n)
{
    int k = 0;
    for (; k + 4 <= count; k += 4, x += 4 * stride, factors += 4 * step) { /* y is read once */
        const double *x1 = x + stride, *x2 = x1 + stride, *x3 = x2 + stride;
        double f0 = sign * factors[0], f1 = sign * factors[step];
        double f2 = sign * factors[2 * step], f3 = sign * factors[3 * step];
        INDEPENDENT for (int i = 0; i < n; i++) y[i] =
            y[i] + f0 * x[i] + f1 * x1[i] + f2 * x2[i] + f3 * x3[i];
    }
    for (; k + 2 <= count; k += 2, x += 2 * stride, factors += 2 * step) {
        const double *x1 = x + stride;
        double f0 = sign * factors[0], f1 = sign * factors[step];
        INDEPENDENT for (int i = 0; i < n; i++) y[i] = y[i] + f0 * x[i] + f1 * x1[i];
    }
    for (; k < count; k++, x += stride, factors += step) {
        double factor = sign * factors[0];
        if (factor != 0.0)
            INDEPENDENT for (int i = 0; i < n; i++) y[i] += factor * x[i];
    }
}

static void swap(double *x, double *y, int n)
{
    for (int j = 0; j < n; j++) {
        double kept = x[j];
        x[j] = y[j];
        y[j] = kept;
    }
}

/* Eliminate column k in the columns of its panel, which ends before `to`. */
static int lu_column(double *matrix, int *pivots, int n, int k, int to)
{
    double *row = matrix + (size_t)k * n, terms = 0.0;
    int best = k;
    for (int i = k + 1; i < n; i++)
        if (fabs(matrix[(size_t)i * n + k]) > fabs(matrix[(size_t)best * n + k]))
            best = i;
    pivots[k] = best;
    if (best != k)
        swap(row, matrix + (size_t)best * n, n);
    for (int i = 0; i < k; i++) /* what the pivot is a difference of, in any scaling */
        terms += fabs(row[i] * matrix[(size_t)i * n + k]);
    if (fabs(row[k]) <= DBL_EPSILON * terms || row[k] == 0.0)
        return -1;
    for (int i = k + 1; i < n; i++) {
        double *below = matrix + (size_t)i * n, factor = below[k] /= row[k];
        for (int j = k + 1; j < to; j++)
            below[j] -= factor * row[j];
    }
    return 0;
}

int lu_factor(double *matrix, int *pivots, int n)
{
    const size_t c = n;
    for (int from = 0; from < n; from += PANEL) {
        int to = from + PANEL < n ? from + PANEL : n;
        for (int k = from; k < to; k++)
            if (lu_column(matrix, pivots, n, k, to))
                return -1;
        for (int i = from + 1; i < n; i++)
            add_rows(matrix + i * c + to, matrix + from * c + to, c, matrix + i * c + from, 1,
                     i < to ? i - from : to - from, -1.0, n - to);
    }
    return 0;
}

void lu_solve(const double *lu, const int *pivots, int n, double *right, int columns)
{
    const size_t c = columns;
    for (int k = 0; k < n; k++)
        if (pivots[k] != k)
            swap(right + k * c, right + pivots[k] * c, columns);
    if (columns == 1) {
        for (int i = 1; i < n; i++)
            right[i] -= dot(lu + (size_t)i * n, right, i);
        for (int i = n - 1; i >= 0; i--) {
            const double *row = lu + (size_t)i * n;
            right[i] = (right[i] - dot(row + i + 1, right + i + 1, n - i - 1)) / row[i];
        }
        return;
    }
    for (int i = 1; i < n; i++)
        add_rows(right + i * c, right, c, lu + (size_t)i * n, 1, i, -1.0, columns);
    for (int i = n - 1; i >= 0; i--) {
        const double *row = lu + (size_t)i * n;
        add_rows(right + i * c, right + (i + 1) * c, c, row + i + 1, 1, n - i - 1, -1.0, columns);
        for (int j = 0; j < columns; j++)
            right[i * c + j] /= row[i];
    }
}

int qr_factor(double *matrix, double *scales, int rows, int n, int columns, double *sums,
              int *sign)
{
    const size_t c = columns;
    for (int k = 0; k < n; k++) {
        double squares = 0.0, *top = matrix + k * c;
        for (int i = k; i < rows; i++)
            squares += matrix[i * c + k] * matrix[i * c + k];
        double length = sqrt(squares);
        if (length == 0.0)
            return -1;
        double diagonal = top[k] > 0.0 ? -length : length, first = top[k] - diagonal;
        scales[k] = -first / diagonal;
        *sign = -*sign; /* of a reflection */
        int rest = columns - k - 1;
        memcpy(sums, top + k + 1, rest * sizeof(double));
        for (int i = k + 1; i < rows; i++)
            matrix[i * c + k] /= first;
        const double *below = top + c;
        add_rows(sums, below + k + 1, c, below + k, c, rows - k - 1, 1.0, rest);
        top[k] = diagonal;
        for (int i = k; i < rows; i++) {
            double factor = i == k ? scales[k] : scales[k] * matrix[i * c + k];
            INDEPENDENT for (int j = 0; j < rest; j++) matrix[i * c + k + 1 + j] -=
                factor * sums[j];
        }
    }
    return 0;
}

void qr_apply(const double *matrix, const double *scales, int rows, int n, int columns,
              double *right)
{
    const size_t c = columns;
    for (int k = 0; k < n; k++) {
        double sum = right[k];
        for (int i = k + 1; i < rows; i++)
            sum += matrix[i * c + k] * right[i];
        sum *= scales[k];
        right[k] -= sum;
        for (int i = k + 1; i < rows; i++)
            right[i] -= matrix[i * c + k] * sum;
    }
}
