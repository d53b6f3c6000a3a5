/* Equations file of AUTO-07p for peer_auto.py: the states of peer_states.py on an arc from 0 to 1.
 *
 * par[0] goes from 0, where the guess is a solution, to 1, where the end is held as it should be;
 * par[1] is the decimal logarithm of epsilon, below -50 for epsilon = 0; par[2] is the length.
 */
#include "auto_f2c.h"

enum { STATES = PEER_STATES, AT_END = PEER_AT_END }; /* conditions at the end: 4, or 5 */

typedef int symbolic(const double **, double **, long long *, double *, int);
symbolic rates, rates_x, rates_epsilon, start, start_x, end, end_x;

static const double missed[AT_END] = {PEER_MISSED}; /* end() of the guess */

static void value(symbolic *f, const double *x, double epsilon, double *out) {
    const double *arg[2] = {x, &epsilon};
    double *res[1] = {out};
    f(arg, res, 0, 0, 0);
}

int func(integer ndim, const doublereal *u, const integer *icp, const doublereal *par, integer ijac,
         doublereal *f, doublereal *dfdu, doublereal *dfdp) {
    double epsilon = par[1] < -50 ? 0 : pow(10, par[1]);
    value(rates, u, epsilon, f);
    for (int j = 0; j < STATES; j++) f[j] *= par[2];
    if (ijac == 0) return 0;
    value(rates_x, u, epsilon, dfdu);
    for (int j = 0; j < STATES * STATES; j++) dfdu[j] *= par[2];
    if (ijac == 1) return 0;
    for (int j = 0; j < STATES; j++) dfdp[j] = 0;
    value(rates_epsilon, u, epsilon, dfdp + STATES);
    for (int j = 0; j < STATES; j++) dfdp[STATES + j] *= par[2] * log(10.0) * epsilon;
    return 0;
}

int bcnd(integer ndim, const doublereal *par, const integer *icp, integer nbc, const doublereal *u0,
         const doublereal *u1, integer ijac, doublereal *f, doublereal *dbc) {
    const int first = STATES - AT_END;
    value(start, u0, 0, f);
    value(end, u1, 0, f + first);
    for (int j = 0; j < AT_END; j++) f[first + j] -= (1 - par[0]) * missed[j];
    if (ijac == 0) return 0;
    double at_start[STATES * STATES], at_end[STATES * AT_END];
    value(start_x, u0, 0, at_start);
    value(end_x, u1, 0, at_end);
    for (int k = 0; k < STATES; k++) {
        double *left = dbc + nbc * k, *right = dbc + nbc * (STATES + k);
        for (int j = 0; j < first; j++) left[j] = at_start[k * first + j], right[j] = 0;
        for (int j = 0; j < AT_END; j++) {
            left[first + j] = 0;
            right[first + j] = at_end[k * AT_END + j];
        }
    }
    if (ijac == 1) return 0;
    double *numbers = dbc + nbc * 2 * STATES;
    for (int j = 0; j < 3 * nbc; j++) numbers[j] = 0;
    for (int j = 0; j < AT_END; j++) numbers[first + j] = missed[j];
    return 0;
}

int stpnt(integer ndim, doublereal t, doublereal *u, doublereal *par) {
    par[0] = 0;
    par[1] = PEER_LOG_EPSILON;
    par[2] = PEER_LENGTH;
    return 0; /* the states are in the file that the constant `dat` names */
}

int icnd(integer ndim, const doublereal *par, const integer *icp, integer nint, const doublereal *u,
         const doublereal *uold, const doublereal *udot, const doublereal *upold, integer ijac,
         doublereal *fi, doublereal *dint) {
    return 0;
}

int fopt(integer ndim, const doublereal *u, const integer *icp, const doublereal *par, integer ijac,
         doublereal *fs, doublereal *dfdu, doublereal *dfdp) {
    return 0;
}

int pvls(integer ndim, const doublereal *u, doublereal *par) { return 0; }
