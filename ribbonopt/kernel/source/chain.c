/* A chain of collocation elements: residuals and derivatives at the stages. */
#include "kernel.h"

#include <stdlib.h>
#include <string.h>

void *allocate(size_t count, size_t size)
{
    return calloc(count ? count : 1, size);
}

void release(void *memory)
{
    free(memory);
}

/* Positions and known fields of every stage, as stage functions take them: (N, K, 1 + nk). */
static void fill_places(const Chain *s, const double *p, double *places)
{
    const double *known = p + s->nt + (size_t)s->nk * (s->phases + 1);
    const double *widths = known + (size_t)s->nk * s->K * s->N;
    for (int phase = 0; phase < s->phases; phase++) {
        double start = 0.0;
        for (int e = s->ends[phase]; e < s->ends[phase + 1]; e++) {
            for (int j = 0; j < s->K; j++) {
                *places++ = start + widths[e] * s->c[j];
                for (int k = 0; k < s->nk; k++)
                    *places++ = *known++;
            }
            start += widths[e];
        }
    }
}

/* Run the programs of the phases at all stages: outputs (N K, ne), maybe (N K, (nv + nc) ne). */
static int at_stages(const Chain *s, const Program *const *programs, const double *w,
                     const double *p, double *equations, double *jacobians)
{
    int most = 0, width = 1 + s->nk;
    for (int phase = 0; phase < s->phases; phase++)
        if (programs[phase]->work > most)
            most = programs[phase]->work;
    double *work = allocate((size_t)most * LANES, sizeof(double));
    double *places = allocate((size_t)s->N * s->K * width, sizeof(double));
    if (!work || !places) {
        release(work);
        release(places);
        return -1;
    }
    fill_places(s, p, places);
    const double *constants = w + s->unknowns - s->nc, *in[4 * LANES];
    double *out[2 * LANES];
    size_t size = (size_t)(s->nv + s->nc) * s->ne;
    for (int l = 0; l < LANES; l++) {
        in[LANES + l] = constants;
        in[2 * LANES + l] = p;
    }
    for (int phase = 0; phase < s->phases; phase++) {
        long stage = (long)s->ends[phase] * s->K, last = (long)s->ends[phase + 1] * s->K;
        while (stage < last) {
            int lanes = last - stage < LANES ? (int)(last - stage) : LANES;
            for (int l = 0; l < LANES; l++) {
                long at = stage + (l < lanes ? l : 0);
                in[l] = w + (at / s->K) * s->element_unknowns + s->nx + (at % s->K) * s->nv;
                in[3 * LANES + l] = places + at * width;
                out[l] = equations + at * s->ne;
                out[LANES + l] = jacobians ? jacobians + at * size : NULL;
            }
            program_run(programs[phase], lanes, in, out, work);
            stage += lanes;
        }
    }
    release(work);
    release(places);
    return 0;
}

/* Conditions (nb,), maybe with their derivatives (nb, (P + 1) nx + nc) by columns. */
static int at_points(const Chain *s, const Program *program, const double *w, const double *p,
                     double *conditions, double *jacobian)
{
    double *work = allocate((size_t)program->work * LANES, sizeof(double));
    double *points = allocate((size_t)(s->phases + 1) * s->nx, sizeof(double));
    if (work && points) {
        for (int i = 0; i <= s->phases; i++)
            memcpy(points + (size_t)i * s->nx, w + (size_t)s->ends[i] * s->element_unknowns,
                   s->nx * sizeof(double));
        const double *in[3 * LANES] = {0};
        double *out[2 * LANES] = {0};
        in[0] = points;
        in[LANES] = w + s->unknowns - s->nc;
        in[2 * LANES] = p;
        out[0] = conditions;
        out[LANES] = jacobian;
        program_run(program, 1, in, out, work);
    }
    int done = work && points;
    release(work);
    release(points);
    return done ? 0 : -1;
}

/* Turn the stages' equations (N K, ne) into residuals: x - x_0 - h a F, then those of the ends. */
static void fill_residuals(const Chain *s, const double *w, const double *p,
                           const double *equations, double *residuals)
{
    const double *widths = p + s->nt + (size_t)s->nk * (s->phases + 1 + (size_t)s->K * s->N);
    for (int e = 0; e < s->N; e++) {
        const double *F = equations + (size_t)e * s->K * s->ne;
        const double *first = w + (size_t)e * s->element_unknowns;
        const double *next = first + s->element_unknowns;
        double *target = residuals + (size_t)e * s->element_equations;
        for (int i = 0; i <= s->K; i++) {
            const double *weights = i < s->K ? s->a + (size_t)i * s->K : s->b;
            const double *x = i < s->K ? first + s->nx + (size_t)i * s->nv : next;
            for (int k = 0; k < s->nx; k++) {
                double sum = 0.0;
                for (int j = 0; j < s->K; j++)
                    sum += weights[j] * F[(size_t)j * s->ne + k];
                target[k] = x[k] - (first[k] + widths[e] * sum);
            }
            if (i < s->K)
                memcpy(target + s->nx, F + (size_t)i * s->ne + s->nx, s->nz * sizeof(double));
            target += s->ne;
        }
    }
}

int chain_linearize(const Chain *s, const double *w, const double *p, double *residuals,
                    double *jacobians, double *condition_jacobian)
{
    double *equations = allocate((size_t)s->N * s->K * s->ne, sizeof(double));
    double *conditions = residuals + (size_t)s->N * s->element_equations;
    int alone = jacobians == NULL;
    int failed = !equations ||
                 at_stages(s, alone ? s->values : s->dense, w, p, equations, jacobians) ||
                 at_points(s, alone ? s->conditions : s->conditions_dense, w, p, conditions,
                           condition_jacobian);
    if (!failed)
        fill_residuals(s, w, p, equations, residuals);
    release(equations);
    return failed ? -1 : 0;
}

int chain_residuals(const Chain *s, const double *w, const double *p, double *residuals)
{
    return chain_linearize(s, w, p, residuals, NULL, NULL);
}
