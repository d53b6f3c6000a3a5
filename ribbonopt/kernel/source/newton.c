/* Newton's method, damped by the natural monotonicity test, factors kept while they contract: the
 * same steps as ribbonopt.solvers.newton takes, which says why. */
#include "kernel.h"

#include <math.h>
#include <string.h>
#include <time.h>

typedef struct {
    const Chain *chain;
    const Settings *settings;
    const double *p, *relaxed;
    double *w, *trial, *step, *following, *residuals, *jacobians, *condition_jacobian;
    Factors *inherited;
    Outcome *outcome;
} Run;

static double now(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Largest entry of a step relative to 1 + |w|; NaN where an entry is none. */
static double size_of(const Run *r, const double *step)
{
    double size = 0.0;
    for (int i = 0; i < r->chain->unknowns; i++) {
        double entry = fabs(step[i]) / (1.0 + fabs(r->w[i]));
        if (!(entry <= size)) {
            size = entry;
            if (isnan(size))
                break;
        }
    }
    return size;
}

static void relax(const Run *r)
{
    const Chain *s = r->chain;
    double *conditions = r->residuals + (size_t)s->N * s->element_equations;
    if (r->relaxed)
        for (int k = 0; k < s->nb; k++)
            conditions[k] -= r->relaxed[k];
}

static int evaluate(const Run *r, const double *w)
{
    double start = now();
    int failed = chain_residuals(r->chain, w, r->p, r->residuals);
    relax(r);
    r->outcome->evaluate += now() - start;
    return failed;
}

/* The step that kept factors give at w. */
static int simplified(const Run *r, const double *w, double *step)
{
    if (evaluate(r, w))
        return -2;
    double start = now();
    const Factors *factors = r->outcome->factors ? r->outcome->factors : r->inherited;
    int failed = factors_solve(factors, r->chain, r->residuals, step);
    r->outcome->linear += now() - start;
    return failed;
}

/* The step of new factors at w: 0, -1 where they are singular, -2 without memory. */
static int newton_step(const Run *r)
{
    double start = now();
    const Chain *s = r->chain;
    if (chain_linearize(s, r->w, r->p, r->residuals, r->jacobians, r->condition_jacobian))
        return -2;
    relax(r);
    double middle = now();
    r->outcome->evaluate += middle - start;
    if (!r->outcome->factors && !(r->outcome->factors = factors_new(s, 0)))
        return -2;
    const double *widths = r->p + s->nt + (size_t)s->nk * (s->phases + 1 + (size_t)s->K * s->N);
    int failed = factors_make(r->outcome->factors, s, r->jacobians, r->condition_jacobian, widths,
                              NULL);
    if (!failed)
        failed = factors_solve(r->outcome->factors, s, r->residuals, r->step);
    r->outcome->linear += now() - middle;
    r->outcome->factorizations += !failed;
    if (failed) { /* they are made in place: none are left */
        factors_free(r->outcome->factors);
        r->outcome->factors = NULL;
    }
    return failed;
}

static void move(double *target, const double *w, const double *step, double damping, int n)
{
    for (int i = 0; i < n; i++)
        target[i] = w[i] + damping * step[i];
}

static void exchange(double **a, double **b)
{
    double *kept = *a;
    *a = *b;
    *b = kept;
}

/* Iterate as long as factors of other equations contract: 1 if that was enough. */
static int with_inherited(Run *r)
{
    int n = r->chain->unknowns;
    if (simplified(r, r->w, r->step))
        return -2;
    while (r->outcome->iterations < r->settings->most) {
        double size = size_of(r, r->step);
        if (!(size < INFINITY))
            return 0;
        move(r->trial, r->w, r->step, 1.0, n);
        if (size <= r->settings->tolerance) {
            memcpy(r->w, r->trial, n * sizeof(double));
            return 1;
        }
        r->outcome->iterations++;
        if (simplified(r, r->trial, r->step))
            return -2;
        if (!(size_of(r, r->step) <= r->settings->inherit * size))
            return 0;
        memcpy(r->w, r->trial, n * sizeof(double));
    }
    return 0;
}

/* At the limit of rounding no step contracts any more; the iterate is as good as it gets. */
static int stalled(const Run *r)
{
    if (evaluate(r, r->w))
        return NO_MEMORY;
    double largest = 0.0, most = 0.0;
    for (int i = 0; i < r->chain->unknowns; i++)
        largest = fmax(largest, fabs(r->w[i]));
    for (int i = 0; i < r->chain->equations; i++) {
        if (isnan(r->residuals[i]))
            return STALLED;
        most = fmax(most, fabs(r->residuals[i]));
    }
    return most <= r->settings->rounding * (1.0 + largest) ? CONVERGED : STALLED;
}

/* Iterate while the factors are good enough: the end reached, or -1. */
static int with_these(Run *r, double *damping)
{
    int n = r->chain->unknowns;
    const Settings *settings = r->settings;
    while (r->outcome->iterations < settings->most) {
        double size = size_of(r, r->step);
        if (size <= settings->tolerance) {
            move(r->w, r->w, r->step, 1.0, n);
            return CONVERGED;
        }
        r->outcome->iterations++;
        move(r->trial, r->w, r->step, *damping, n);
        if (simplified(r, r->trial, r->following))
            return NO_MEMORY;
        double contraction = size_of(r, r->following) / size;
        if (!(contraction <= 1.0 - *damping / 4.0)) {
            if (*damping < settings->smallest_damping)
                return stalled(r);
            *damping /= 4.0;
            continue;
        }
        memcpy(r->w, r->trial, n * sizeof(double));
        if (*damping < 1.0)
            break;
        exchange(&r->step, &r->following);
        if (contraction > settings->keep && size_of(r, r->step) > settings->tolerance)
            break;
    }
    return -1;
}

static int iterate(Run *r)
{
    double damping = 1.0;
    if (r->inherited) {
        int done = with_inherited(r);
        if (done)
            return done == 1 ? CONVERGED : NO_MEMORY;
    }
    while (r->outcome->iterations < r->settings->most) {
        if (r->settings->interrupted && r->settings->interrupted())
            return INTERRUPTED;
        int failed = newton_step(r);
        if (failed)
            return failed == -1 ? SINGULAR : NO_MEMORY;
        for (int i = 0; i < r->chain->unknowns; i++)
            if (!isfinite(r->step[i]))
                return INVALID_NUMBER;
        damping = fmin(1.0, 4.0 * damping);
        int status = with_these(r, &damping);
        if (status >= 0)
            return status;
    }
    return MAX_ITERATIONS;
}

void newton(const Chain *s, double *w, const double *p, const double *relaxed, Factors *inherited,
            const Settings *settings, double *residuals, Outcome *outcome)
{
    size_t n = s->unknowns, jacobians = (size_t)s->N * s->K * s->ne * (s->nv + s->nc);
    size_t last = (size_t)s->nb * chain_last(s);
    double *memory = allocate(3 * n + jacobians + last, sizeof(double));
    memset(outcome, 0, sizeof(Outcome));
    if (!memory) {
        outcome->status = NO_MEMORY;
        return;
    }
    double *step = memory + n, *following = step + n, *derivatives = following + n;
    Run run = {s,         settings,  p,           relaxed,                 w,         memory, step,
               following, residuals, derivatives, derivatives + jacobians, inherited, outcome};
    outcome->status = iterate(&run);
    if (outcome->status != NO_MEMORY && chain_residuals(s, w, p, residuals))
        outcome->status = NO_MEMORY;
    relax(&run);
    release(memory);
}
