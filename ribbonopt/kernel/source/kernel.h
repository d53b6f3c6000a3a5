/* The compiled kernel: CasADi's instruction lists over many points at once, Newton steps of a chain
 * of collocation elements, Newton's loop. Plain numbers; files with `objects.h` know Python.
 *
 * Shapes as in ribbonopt.transcription.structure: N elements, K stages, nx states, nv = nx + nz
 * unknowns of a stage, nz algebraic equations, nc constants, nb conditions, P + 1 points. Matrices
 * are stored by rows, but for Jacobians of CasADi, which are stored by columns. */
#ifndef RIBBONOPT_KERNEL_H
#define RIBBONOPT_KERNEL_H

#include <stddef.h>

/* Sizes that are checked at the door have products of 64 bits; elsewhere numpy does it. */
_Static_assert(sizeof(size_t) >= 8 && sizeof(int) >= 4, "the kernel is for 64 bits");

#if defined(__clang__) /* of each other: the rounds of the loop that follows */
#pragma clang diagnostic ignored "-Wpass-failed" /* such loops as are no better so are left */
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define INDEPENDENT _Pragma("GCC ivdep")
#else
#define INDEPENDENT
#endif

#define INTERFACE 1 /* to be raised with that of ribbonopt/kernel/__init__.py */
#define LANES 16 /* points that an instruction serves at once */
#define OPS(X)                                                                                     \
    X(INPUT) X(OUTPUT) X(CONST) X(ASSIGN) X(ADD) X(SUB) X(MUL) X(DIV) X(NEG) X(EXP) X(LOG) X(POW)  \
    X(CONSTPOW) X(SQRT) X(SQ) X(TWICE) X(SIN) X(COS) X(TAN) X(ASIN) X(ACOS) X(ATAN) X(LT) X(LE)    \
    X(EQ) X(NE) X(NOT) X(AND) X(OR) X(FLOOR) X(CEIL) X(FMOD) X(FABS) X(SIGN) X(COPYSIGN)           \
    X(IF_ELSE_ZERO) X(ERF) X(FMIN) X(FMAX) X(INV) X(SINH) X(COSH) X(TANH) X(ASINH) X(ACOSH)        \
    X(ATANH) X(ATAN2) X(LIFT) X(LOG1P) X(EXPM1) X(HYPOT) X(REMAINDER)
#define NAMED(name) OP_##name,
enum { OPS(NAMED) OP_COUNT };

/* INPUT: out = number a of input b; OUTPUT: number out of output b = a; CONST: out = value. */
typedef struct {
    int op, out, a, b;
    double value;
} Instruction;

typedef struct {
    int count, work, inputs, outputs;
    int *sizes_in, *sizes_out;
    Instruction *code;
} Program;

/* Run at 1 <= lanes <= LANES points: in[i * LANES + l] and out[i * LANES + l] are input and output
 * i of point l; `in` is read for all LANES. `work` holds program->work * LANES numbers. */
void program_run(const Program *program, int lanes, const double *const *in, double *const *out,
                 double *work);

/* y (n) += sum_k sign * factors[k * step] * x[k * stride + .], count terms, in that order. */
void add_rows(double *y, const double *x, size_t stride, const double *factors, size_t step,
              int count, double sign, int n);
static inline double dot(const double *x, const double *y, int n)
{
    double even = 0.0, odd = 0.0, third = 0.0, fourth = 0.0;
    int i = 0;
    for (; i + 4 <= n; i += 4) {
        even += x[i] * y[i];
        odd += x[i + 1] * y[i + 1];
        third += x[i + 2] * y[i + 2];
        fourth += x[i + 3] * y[i + 3];
    }
    for (; i < n; i++)
        even += x[i] * y[i];
    return (even + odd) + (third + fourth);
}
/* LU factors with partial pivoting, in place; -1 where a pivot is the rounding of its terms. */
int lu_factor(double *matrix, int *pivots, int n);
void lu_solve(const double *lu, const int *pivots, int n, double *right, int columns);
/* Householder QR of the first n columns: R and the vectors in place, all columns transformed; -1
 * where R is singular. *sign is multiplied by the determinant of Q, `sums` has `columns` numbers. */
int qr_factor(double *matrix, double *scales, int rows, int n, int columns, double *sums,
              int *sign);
/* Apply the reflections to a right-hand side (rows,); the matrix is as qr_factor left it. */
void qr_apply(const double *matrix, const double *scales, int rows, int n, int columns,
              double *right);

/* One discretised problem. Where it is only to be eliminated it has no programs. */
typedef struct {
    int phases, *ends; /* elements before each phase and all; phases + 1 */
    int N, K, nx, nz, nv, nc, ne, nb, nk, nt, unknowns, equations;
    int element_unknowns, element_equations;
    double *a, *b, *c; /* tableau: (K, K), (K,), (K,) */
    int held, *q, nr, *r; /* a stage's unknowns to factor, the first `held` states; the others */
    const Program **values, **dense, *conditions, *conditions_dense;
} Chain;

/* Factors of one Newton matrix. `only` ones hold the stages' answer to one residual instead. */
typedef struct {
    int only, *pivots, *last_pivots, sign;
    double log; /* sign and logarithm of the determinant */
    double *h_jacobians; /* (N, K, ne, nv) times h where derivatives, by rows */
    double *lu;          /* (N, n, n) */
    double *by_ends;     /* (N, K nv, nx + nc): stages by first node and constants */
    double *shares;      /* (N, K nv) where `only` */
    double *merges;      /* (N, 2 nx, 3 nx + nc): merge of each element with those before */
    double *scales;      /* (N, nx) */
    double *last;        /* LU of the last system */
} Factors;

/* An element: `factor` gives h J (K, ne, nv), the LU of q, stages by its ends (K nv, nx + nc) and its
 * relation [A C] (nx, nx + nc), next to B = 1; -1 where it is singular. `share` gives the stages
 * (K nv) where first node and constants stay, `step` the right-hand side (nx,) of the relation. */
size_t element_scratch(const Chain *chain);
int element_factor(const Chain *chain, const double *jacobians, double h, double *h_jacobian,
                   double *lu, int *pivots, double *by_ends, double *relation, double *scratch);
void element_share(const Chain *chain, const double *h_jacobian, const double *lu,
                   const int *pivots, const double *residuals, double *share, double *scratch);
void element_step(const Chain *chain, const double *h_jacobian, const double *residuals,
                  const double *share, double *right);

int chain_last(const Chain *chain); /* size of the last system */
/* Residuals in the order of the layout; `rates` (N K ne) is scratch. -1: no memory. */
int chain_residuals(const Chain *chain, const double *w, const double *p, double *residuals);
int chain_linearize(const Chain *chain, const double *w, const double *p, double *residuals,
                    double *jacobians, double *condition_jacobian);
Factors *factors_new(const Chain *chain, int only);
void factors_free(Factors *factors);
/* 0, -1 where singular, -2 without memory; `residuals` where factors are for these only. */
int factors_make(Factors *factors, const Chain *chain, const double *jacobians,
                 const double *condition_jacobian, const double *widths, const double *residuals);
int factors_solve(const Factors *factors, const Chain *chain, const double *residuals,
                  double *step);

enum { CONVERGED, MAX_ITERATIONS, SINGULAR, INVALID_NUMBER, STALLED, NO_MEMORY, INTERRUPTED };

typedef struct {
    double tolerance, keep, inherit, smallest_damping, rounding;
    int most;
    int (*interrupted)(void);
} Settings;

typedef struct {
    int status, iterations, factorizations;
    double evaluate, linear;
    Factors *factors; /* those of the last matrix, or what was inherited */
} Outcome;

/* Newton's method from w, in place; `residuals` are those at its end. */
void newton(const Chain *chain, double *w, const double *p, const double *relaxed,
            Factors *inherited, const Settings *settings, double *residuals, Outcome *outcome);

/* Writhe of the closed polygon r (count, 3). */
double writhe(const double *r, long count);

void *allocate(size_t count, size_t size);
void release(void *memory);

#endif
