/* What chains and their factors do for Python. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include "kernel.h"
#include "objects.h"

static FactorsObject *factors_object(ChainObject *chain, Factors *factors)
{
    FactorsObject *self = PyObject_New(FactorsObject, &FactorsType);
    if (!self) {
        factors_free(factors);
        return NULL;
    }
    Py_INCREF(chain);
    self->chain = chain;
    self->factors = factors;
    return self;
}

static void factors_dealloc(PyObject *self)
{
    factors_free(((FactorsObject *)self)->factors);
    Py_XDECREF(((FactorsObject *)self)->chain);
    PyObject_Free(self);
}

static PyObject *factors_object_solve(PyObject *self, PyObject *args)
{
    PyObject *residuals, *step;
    const FactorsObject *own = (FactorsObject *)self;
    const Chain *s = &own->chain->chain;
    if (!PyArg_ParseTuple(args, "OO", &residuals, &step))
        return NULL;
    Held held = {0};
    double *r = held_numbers(&held, residuals, s->equations, 0, "residuals");
    double *x = r ? held_numbers(&held, step, s->unknowns, 1, "step") : NULL;
    if (x && factors_solve(own->factors, s, r, x))
        PyErr_NoMemory();
    held_release(&held);
    if (PyErr_Occurred())
        return NULL;
    Py_RETURN_NONE;
}

static PyObject *factors_determinant(PyObject *self, void *Py_UNUSED(closure))
{
    const Factors *f = ((FactorsObject *)self)->factors;
    return Py_BuildValue("dd", (double)f->sign, f->log);
}

static PyMethodDef factors_methods[] = {
    {"solve", factors_object_solve, METH_VARARGS,
     "solve(residuals, step): fill the Newton step (nw,) for residuals in the layout's order."},
    {NULL, NULL, 0, NULL}};
static PyGetSetDef factors_values[] = {
    {"determinant", factors_determinant, NULL, "Sign and logarithm of the determinant.", NULL},
    {NULL, NULL, NULL, NULL, NULL}};

PyTypeObject FactorsType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "ribbonopt.kernel._compiled.Factors",
    .tp_doc = "Factors of a chain's Newton matrix.",
    .tp_basicsize = sizeof(FactorsObject),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_dealloc = factors_dealloc,
    .tp_methods = factors_methods,
    .tp_getset = factors_values,
};

/* ---- chains ---------------------------------------------------------------------------------- */

static size_t parameters_of(const Chain *s)
{
    return s->nt + (size_t)s->nk * (s->phases + 1 + (size_t)s->K * s->N) + s->N;
}

static int has_programs(const Chain *s)
{
    if (s->conditions_dense)
        return 1;
    PyErr_SetString(PyExc_ValueError, "a chain without programs cannot be evaluated");
    return 0;
}

static PyObject *chain_object_residuals(PyObject *self, PyObject *args)
{
    PyObject *w, *p, *residuals;
    const Chain *s = &((ChainObject *)self)->chain;
    if (!PyArg_ParseTuple(args, "OOO", &w, &p, &residuals) || !has_programs(s))
        return NULL;
    Held held = {0};
    double *x, *numbers, *r;
    if ((x = held_numbers(&held, w, s->unknowns, 0, "w")) &&
        (numbers = held_numbers(&held, p, parameters_of(s), 0, "p")) &&
        (r = held_numbers(&held, residuals, s->equations, 1, "residuals")) &&
        chain_residuals(s, x, numbers, r))
        PyErr_NoMemory();
    held_release(&held);
    if (PyErr_Occurred())
        return NULL;
    Py_RETURN_NONE;
}

static PyObject *chain_object_linearize(PyObject *self, PyObject *args)
{
    PyObject *arrays[5];
    const Chain *s = &((ChainObject *)self)->chain;
    if (!PyArg_ParseTuple(args, "OOOOO", arrays, arrays + 1, arrays + 2, arrays + 3, arrays + 4) ||
        !has_programs(s))
        return NULL;
    size_t jacobians = (size_t)s->N * s->K * s->ne * (s->nv + s->nc);
    Held held = {0};
    double *w, *p, *r, *J, *c;
    if ((w = held_numbers(&held, arrays[0], s->unknowns, 0, "w")) &&
        (p = held_numbers(&held, arrays[1], parameters_of(s), 0, "p")) &&
        (r = held_numbers(&held, arrays[2], s->equations, 1, "residuals")) &&
        (J = held_numbers(&held, arrays[3], jacobians, 1, "jacobians")) &&
        (c = held_numbers(&held, arrays[4], (size_t)s->nb * chain_last(s), 1, "conditions")) &&
        chain_linearize(s, w, p, r, J, c))
        PyErr_NoMemory();
    held_release(&held);
    if (PyErr_Occurred())
        return NULL;
    Py_RETURN_NONE;
}

/* Returns None where the matrix is singular. */
static PyObject *chain_object_factor(PyObject *self, PyObject *args)
{
    PyObject *arrays[4];
    ChainObject *own = (ChainObject *)self;
    const Chain *s = &own->chain;
    if (!PyArg_ParseTuple(args, "OOOO", arrays, arrays + 1, arrays + 2, arrays + 3))
        return NULL;
    size_t jacobians = (size_t)s->N * s->K * s->ne * (s->nv + s->nc);
    Held held = {0};
    double *J, *c, *h, *r = NULL;
    Factors *factors = NULL;
    int only = arrays[3] != Py_None, failed = -2;
    if ((J = held_numbers(&held, arrays[0], jacobians, 0, "jacobians")) &&
        (c = held_numbers(&held, arrays[1], (size_t)s->nb * chain_last(s), 0, "conditions")) &&
        (h = held_numbers(&held, arrays[2], s->N, 0, "widths")) &&
        (!only || (r = held_numbers(&held, arrays[3], s->equations, 0, "residuals")))) {
        factors = factors_new(s, only);
        failed = factors ? factors_make(factors, s, J, c, h, r) : -2;
        if (failed == -2)
            PyErr_NoMemory();
    }
    held_release(&held);
    if (!failed)
        return (PyObject *)factors_object(own, factors);
    factors_free(factors);
    if (PyErr_Occurred())
        return NULL;
    Py_RETURN_NONE;
}

static int same_sizes(const Chain *a, const Chain *b)
{
    int same = a->phases == b->phases && a->K == b->K && a->nx == b->nx && a->nz == b->nz &&
               a->nc == b->nc && a->nr == b->nr;
    for (int i = 0; same && i <= a->phases; i++)
        same = a->ends[i] == b->ends[i];
    for (int i = 0; same && i < a->nr; i++)
        same = a->r[i] == b->r[i];
    for (int i = 0; same && i < a->nv - a->nr; i++)
        same = a->q[i] == b->q[i];
    return same && !memcmp(a->a, b->a, (size_t)a->K * (a->K + 2) * sizeof(double));
}

static PyObject *chain_object_newton(PyObject *self, PyObject *args)
{
    PyObject *w, *p, *relaxed, *factors, *residuals;
    ChainObject *own = (ChainObject *)self;
    const Chain *s = &own->chain;
    Settings settings = {.interrupted = PyErr_CheckSignals};
    if (!PyArg_ParseTuple(args, "OOOOO(dddddi)", &w, &p, &relaxed, &factors, &residuals,
                          &settings.tolerance, &settings.keep, &settings.inherit,
                          &settings.smallest_damping, &settings.rounding, &settings.most) ||
        !has_programs(s))
        return NULL;
    Factors *inherited = NULL;
    if (factors != Py_None) {
        FactorsObject *given = (FactorsObject *)factors;
        if (!PyObject_TypeCheck(factors, &FactorsType) || given->factors->only ||
            !same_sizes(s, &given->chain->chain)) {
            PyErr_SetString(PyExc_ValueError, "factors: expected those of a chain as large");
            return NULL;
        }
        inherited = given->factors;
    }
    Held held = {0};
    Outcome outcome = {.status = NO_MEMORY};
    double *x, *numbers, *r, *relax = NULL;
    if ((x = held_numbers(&held, w, s->unknowns, 1, "w")) &&
        (numbers = held_numbers(&held, p, parameters_of(s), 0, "p")) &&
        (r = held_numbers(&held, residuals, s->equations, 1, "residuals")) &&
        (relaxed == Py_None || (relax = held_numbers(&held, relaxed, s->nb, 0, "relaxed")))) {
        newton(s, x, numbers, relax, inherited, &settings, r, &outcome);
        if (outcome.status == NO_MEMORY)
            PyErr_NoMemory();
    }
    held_release(&held);
    if (PyErr_Occurred()) { /* an interrupt, too */
        factors_free(outcome.factors);
        return NULL;
    }
    PyObject *kept = factors;
    if (outcome.factors)
        kept = (PyObject *)factors_object(own, outcome.factors);
    else
        Py_INCREF(kept);
    return kept ? Py_BuildValue("iiiddN", outcome.status, outcome.iterations,
                                outcome.factorizations, outcome.evaluate, outcome.linear, kept)
                : NULL;
}

PyMethodDef chain_methods[] = {
    {"residuals", chain_object_residuals, METH_VARARGS, "residuals(w, p, residuals)"},
    {"linearize", chain_object_linearize, METH_VARARGS,
     "linearize(w, p, residuals, jacobians, condition_jacobian)"},
    {"factor", chain_object_factor, METH_VARARGS,
     "factor(jacobians, condition_jacobian, widths, only): Factors, or None where singular."},
    {"newton", chain_object_newton, METH_VARARGS,
     "newton(w, p, relaxed, factors, residuals, settings): iterate from w, in place."},
    {NULL, NULL, 0, NULL}};
