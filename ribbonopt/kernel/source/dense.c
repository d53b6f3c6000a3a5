/* Small dense matrices, stored by rows. */
#include "kernel.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* y -= factor * x */
static void subtract(double *y, const double *x, double factor, int n)
{
    INDEPENDENT for (int j = 0; j < n; j++) y[j] -= factor * x[j];
}

static void swap(double *x, double *y, int n)
{
    for (int j = 0; j < n; j++) {
        double kept = x[j];
        x[j] = y[j];
        y[j] = kept;
    }
}

int lu_factor(double *matrix, int *pivots, int n)
{
    for (int k = 0; k < n; k++) {
        double *row = matrix + (size_t)k * n, largest = 0.0;
        int best = k;
        for (int i = 0; i < k; i++)
            largest = fmax(largest, fabs(matrix[(size_t)i * n + k]));
        for (int i = k + 1; i < n; i++)
            if (fabs(matrix[(size_t)i * n + k]) > fabs(matrix[(size_t)best * n + k]))
                best = i;
        pivots[k] = best;
        if (best != k)
            swap(row, matrix + (size_t)best * n, n);
        if (fabs(row[k]) <= DBL_EPSILON * largest || row[k] == 0.0)
            return -1;
        for (int i = k + 1; i < n; i++) {
            double *below = matrix + (size_t)i * n, factor = below[k] /= row[k];
            if (factor != 0.0)
                subtract(below + k + 1, row + k + 1, factor, n - k - 1);
        }
    }
    return 0;
}

void lu_solve(const double *lu, const int *pivots, int n, double *right, int columns)
{
    const size_t c = columns;
    for (int k = 0; k < n; k++)
        if (pivots[k] != k)
            swap(right + k * c, right + pivots[k] * c, columns);
    for (int i = 1; i < n; i++)
        for (int k = 0; k < i; k++)
            if (lu[(size_t)i * n + k] != 0.0)
                subtract(right + i * c, right + k * c, lu[(size_t)i * n + k], columns);
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++)
            subtract(right + i * c, right + k * c, lu[(size_t)i * n + k], columns);
        for (int j = 0; j < columns; j++)
            right[i * c + j] /= lu[(size_t)i * n + i];
    }
}

int qr_factor(double *matrix, double *scales, int rows, int n, int columns, double *sums,
              int *sign)
{
    const size_t c = columns;
    for (int k = 0; k < n; k++) {
        double squares = 0.0, above = 0.0, *top = matrix + k * c;
        for (int i = 0; i < k; i++)
            above += matrix[i * c + k] * matrix[i * c + k];
        for (int i = k; i < rows; i++)
            squares += matrix[i * c + k] * matrix[i * c + k];
        double length = sqrt(squares);
        if (length <= DBL_EPSILON * sqrt(above) || length == 0.0)
            return -1;
        double diagonal = top[k] > 0.0 ? -length : length, first = top[k] - diagonal;
        scales[k] = -first / diagonal;
        *sign = -*sign; /* of a reflection */
        int rest = columns - k - 1;
        memcpy(sums, top + k + 1, rest * sizeof(double));
        for (int i = k + 1; i < rows; i++) {
            matrix[i * c + k] /= first;
            subtract(sums, matrix + i * c + k + 1, -matrix[i * c + k], rest);
        }
        top[k] = diagonal;
        subtract(top + k + 1, sums, scales[k], rest);
        for (int i = k + 1; i < rows; i++)
            subtract(matrix + i * c + k + 1, sums, scales[k] * matrix[i * c + k], rest);
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
