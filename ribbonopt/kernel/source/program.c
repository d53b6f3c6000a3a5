/* Interpreter of CasADi's SX instruction lists: each instruction serves LANES points at once. */
#include "kernel.h"

#include <math.h>

#if defined(__GNUC__)
#define ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE inline
#endif
/* What is written is an operand itself, or apart from the operands. */
#define DO(name, expression)                                                                       \
    case OP_##name:                                                                                \
        INDEPENDENT for (int l = 0; l < width; l++) z[l] = (expression);                           \
        break;

static ALWAYS_INLINE void run(const Program *program, const int width, int lanes,
                              const double *const *in, double *const *out, double *work)
{
    const Instruction *end = program->code + program->count;
    for (const Instruction *i = program->code; i < end; i++) {
        if (i->op == OP_INPUT) {
            double *z = work + (size_t)i->out * width;
            const double *const *source = in + (size_t)i->b * LANES;
            for (int l = 0; l < width; l++)
                z[l] = source[l][i->a];
            continue;
        }
        const double *x = work + (size_t)i->a * width;
        if (i->op == OP_OUTPUT) {
            double *const *target = out + (size_t)i->b * LANES;
            for (int l = 0; l < lanes; l++)
                target[l][i->out] = x[l];
            continue;
        }
        const double *y = work + (size_t)i->b * width;
        double *z = work + (size_t)i->out * width;
        switch (i->op) {
            DO(CONST, i->value)
            DO(ASSIGN, x[l])
            DO(LIFT, x[l])
            DO(ADD, x[l] + y[l])
            DO(SUB, x[l] - y[l])
            DO(MUL, x[l] * y[l])
            DO(DIV, x[l] / y[l])
            DO(NEG, -x[l])
            DO(INV, 1.0 / x[l])
            DO(SQ, x[l] * x[l])
            DO(TWICE, 2.0 * x[l])
            DO(SQRT, sqrt(x[l]))
            DO(FABS, fabs(x[l]))
            DO(EXP, exp(x[l]))
            DO(LOG, log(x[l]))
            DO(POW, pow(x[l], y[l]))
            DO(CONSTPOW, pow(x[l], y[l]))
            DO(SIN, sin(x[l]))
            DO(COS, cos(x[l]))
            DO(TAN, tan(x[l]))
            DO(ASIN, asin(x[l]))
            DO(ACOS, acos(x[l]))
            DO(ATAN, atan(x[l]))
            DO(ATAN2, atan2(x[l], y[l]))
            DO(SINH, sinh(x[l]))
            DO(COSH, cosh(x[l]))
            DO(TANH, tanh(x[l]))
            DO(ASINH, asinh(x[l]))
            DO(ACOSH, acosh(x[l]))
            DO(ATANH, atanh(x[l]))
            DO(LT, x[l] < y[l] ? 1.0 : 0.0)
            DO(LE, x[l] <= y[l] ? 1.0 : 0.0)
            DO(EQ, x[l] == y[l] ? 1.0 : 0.0)
            DO(NE, x[l] != y[l] ? 1.0 : 0.0)
            DO(NOT, x[l] == 0.0 ? 1.0 : 0.0)
            DO(AND, x[l] != 0.0 && y[l] != 0.0 ? 1.0 : 0.0)
            DO(OR, x[l] != 0.0 || y[l] != 0.0 ? 1.0 : 0.0)
            DO(IF_ELSE_ZERO, x[l] != 0.0 ? y[l] : 0.0)
            DO(FLOOR, floor(x[l]))
            DO(CEIL, ceil(x[l]))
            DO(FMOD, fmod(x[l], y[l]))
            DO(REMAINDER, remainder(x[l], y[l]))
            DO(SIGN, x[l] < 0.0 ? -1.0 : x[l] > 0.0 ? 1.0 : x[l])
            DO(COPYSIGN, copysign(x[l], y[l]))
            DO(FMIN, fmin(x[l], y[l]))
            DO(FMAX, fmax(x[l], y[l]))
            DO(ERF, erf(x[l]))
            DO(LOG1P, log1p(x[l]))
            DO(EXPM1, expm1(x[l]))
            DO(HYPOT, hypot(x[l], y[l]))
        }
    }
}

void program_run(const Program *program, int lanes, const double *const *in, double *const *out,
                 double *work)
{
    if (lanes == 1)
        run(program, 1, 1, in, out, work);
    else if (lanes <= 4)
        run(program, 4, lanes, in, out, work);
    else
        run(program, LANES, lanes, in, out, work);
}
