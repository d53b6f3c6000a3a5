/* COLNEW in a loop on the states of peer_states.py, timed; built and run by peer_colnew.py.
 *
 * colnew GUESS length fixed stages intervals tolerance times epsilon...
 *
 * GUESS has 21 lines (s, states), linear in between; `fixed` is a point that stays in the mesh,
 * 0 for none. With more than one epsilon each starts from the answer before. A line for each of
 * `times` runs: CPU seconds, flag, intervals, and the last n(0), m(0).
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { STATES = PEER_STATES, NODES = 21, REALS = 20000000, INTEGERS = 500000 };
enum { AT_START = PEER_AT_START }; /* conditions there */

typedef int symbolic(const double **, double **, long long *, double *, int);
symbolic rates, rates_x, start, start_x, end, end_x;
void colnew_(int *, int *, double *, double *, double *, int *, int *, double *, double *, int *,
             double *, int *, void (*)(), void (*)(), void (*)(), void (*)(), void (*)());
void appsln_(double *, double *, double *, int *);

static double epsilon, nodes[NODES], guesses[NODES][STATES], reals[REALS];
static int integers[INTEGERS];

static void value(symbolic *f, const double *x, double *out) {
    const double *arg[2] = {x, &epsilon};
    double *res[1] = {out};
    f(arg, res, 0, 0, 0);
}

static void fsub(double *s, double *x, double *out) { value(rates, x, out); }

static void dfsub(double *s, double *x, double *out) { value(rates_x, x, out); }

static void gsub(int *i, double *x, double *out) {
    double all[STATES];
    int here = *i <= AT_START;
    value(here ? start : end, x, all);
    *out = all[*i - 1 - (here ? 0 : AT_START)];
}

static void dgsub(int *i, double *x, double *out) {
    double all[STATES * STATES];
    int here = *i <= AT_START, rows = here ? AT_START : STATES - AT_START;
    value(here ? start_x : end_x, x, all);
    for (int j = 0; j < STATES; j++) out[j] = all[j * rows + *i - 1 - (here ? 0 : AT_START)];
}

static void guess(double *s, double *x, double *slope) {
    int k = 0;
    while (k < NODES - 2 && nodes[k + 1] < *s) k++;
    double t = (*s - nodes[k]) / (nodes[k + 1] - nodes[k]);
    for (int j = 0; j < STATES; j++) x[j] = (1 - t) * guesses[k][j] + t * guesses[k + 1][j];
    value(rates, x, slope);
}

int main(int count, char **words) {
    FILE *file = fopen(words[1], "r");
    if (!file) return 2;
    for (int k = 0; k < NODES; k++) {
        if (fscanf(file, "%lf", &nodes[k]) != 1) return 2;
        for (int j = 0; j < STATES; j++)
            if (fscanf(file, "%lf", &guesses[k][j]) != 1) return 2;
    }
    fclose(file);
    double left = 0, right = atof(words[2]), fixed = atof(words[3]), tolerance = atof(words[6]);
    int stages = atoi(words[4]), intervals = atoi(words[5]), times = atoi(words[7]);
    int states = STATES, orders[STATES], which[STATES], flag = 0;
    double places[STATES], tolerances[STATES], at_first[STATES];
    for (int j = 0; j < STATES; j++) {
        orders[j] = 1;
        which[j] = j + 1;
        tolerances[j] = tolerance;
        places[j] = j < AT_START ? left : right;
    }
    for (int run = 0; run < times; run++) {
        clock_t begun = clock();
        for (int k = 8; k < count; k++) {
            int again = k > 8;
            int settings[11] = {1, stages, again ? integers[0] : intervals, STATES, REALS, INTEGERS,
                                1, 0, again ? 3 : 1, 0, fixed > 0};
            epsilon = atof(words[k]);
            colnew_(&states, orders, &left, &right, places, settings, which, tolerances, &fixed,
                    integers, reals, &flag, fsub, dfsub, gsub, dgsub, guess);
            if (flag != 1) break;
        }
        double seconds = (double)(clock() - begun) / CLOCKS_PER_SEC;
        memset(at_first, 0, sizeof at_first);
        if (flag == 1) appsln_(&left, at_first, reals, integers);
        printf("%.9f %d %d", seconds, flag, integers[0]);
        for (int j = STATES - 6; j < STATES; j++) printf(" %.17g", at_first[j]);
        printf("\n");
    }
    return 0;
}
