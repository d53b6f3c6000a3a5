/* Chains for Python: how they are made. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include "kernel.h"
#include "objects.h"

static void chain_dealloc(PyObject *self)
{
    Chain *s = &((ChainObject *)self)->chain;
    release(s->ends);
    release(s->a);
    release(s->q);
    release(s->r);
    release(s->values);
    release(s->dense);
    Py_XDECREF(((ChainObject *)self)->programs);
    Py_TYPE(self)->tp_free(self);
}

/* Check a program's sizes of inputs and outputs; NULL and an error if they are others. */
static const Program *program_of(PyObject *object, int inputs, const int *in, int outputs,
                                 const int *out)
{
    if (!PyObject_TypeCheck(object, &ProgramType)) {
        PyErr_SetString(PyExc_TypeError, "programs: expected a Program");
        return NULL;
    }
    const Program *p = &((ProgramObject *)object)->program;
    int fits = p->inputs == inputs && p->outputs == outputs;
    for (int i = 0; fits && i < inputs; i++)
        fits = p->sizes_in[i] == in[i];
    for (int i = 0; fits && i < outputs; i++)
        fits = p->sizes_out[i] == out[i];
    if (!fits)
        PyErr_SetString(PyExc_ValueError, "programs: other sizes than the chain has");
    return fits ? p : NULL;
}

/* Programs (values, dense of each phase, conditions, their dense ones), or none. */
static int take_programs(ChainObject *self, PyObject *programs)
{
    Chain *s = &self->chain;
    Py_INCREF(programs);
    self->programs = programs;
    s->values = allocate(s->phases, sizeof(Program *));
    s->dense = allocate(s->phases, sizeof(Program *));
    if (!s->values || !s->dense) {
        PyErr_NoMemory();
        return -1;
    }
    if (PyTuple_GET_SIZE(programs) == 0)
        return 0;
    if (PyTuple_GET_SIZE(programs) != 2 * s->phases + 2) {
        PyErr_SetString(PyExc_ValueError, "programs: expected two for each phase, and two");
        return -1;
    }
    int in[4] = {s->nv, s->nc, s->nt, 1 + s->nk};
    int out[2] = {s->ne, s->ne * (s->nv + s->nc)}, last = 2 * s->phases;
    for (int i = 0; i < s->phases; i++) {
        s->values[i] = program_of(PyTuple_GET_ITEM(programs, 2 * i), 4, in, 1, out);
        if (!s->values[i])
            return -1;
        s->dense[i] = program_of(PyTuple_GET_ITEM(programs, 2 * i + 1), 4, in, 2, out);
        if (!s->dense[i])
            return -1;
    }
    int at[3] = {(s->phases + 1) * s->nx, s->nc, s->nt + s->nk * (s->phases + 1)};
    double derivatives = (double)s->nb * chain_last(s);
    int found[2] = {s->nb, derivatives > MOST ? -1 : (int)derivatives}; /* -1: none have as many */
    s->conditions = program_of(PyTuple_GET_ITEM(programs, last), 3, at, 1, found);
    if (!s->conditions)
        return -1;
    s->conditions_dense = program_of(PyTuple_GET_ITEM(programs, last + 1), 3, at, 2, found);
    return s->conditions_dense ? 0 : -1;
}

/* Check which unknowns are factored: each once, the states first, algebraic ones all. */
static int take_order(Chain *s, PyObject *q, PyObject *r)
{
    int nq, seen = 0;
    if (!(s->q = integers(q, &nq, "q")) || !(s->r = integers(r, &s->nr, "r")))
        return -1;
    s->held = nq - s->nz;
    for (int v = 0; v < s->nv && nq + s->nr == s->nv; v++) {
        int found = 0;
        for (int i = 0; i < nq; i++)
            found += s->q[i] == v && (i < s->held) == (v < s->nx);
        for (int i = 0; i < s->nr; i++)
            found += s->r[i] == v && v < s->nx;
        seen += found == 1;
    }
    if (seen == s->nv)
        return 0;
    PyErr_SetString(PyExc_ValueError, "q, r: expected every unknown of a stage once");
    return -1;
}

static int take_sizes(Chain *s, PyObject *ends, PyObject *tableau)
{
    int points;
    if (!(s->ends = integers(ends, &points, "ends")))
        return -1;
    s->phases = points - 1;
    int fits = s->phases > 0 && s->ends[0] == 0 && s->K > 0 && s->nx > 0;
    for (int i = 0; fits && i < s->phases; i++)
        fits = s->ends[i] < s->ends[i + 1];
    fits = fits && s->nx <= MOST_STATES && s->nz <= MOST_STATES && s->nc <= MOST_STATES &&
           s->K <= MOST_STATES && s->nk <= MOST_STATES && s->phases < MOST_STATES &&
           s->nt >= 0 && s->nt <= MOST && s->nk >= 0 && s->nz >= 0 && s->nc >= 0 && s->ends[s->phases] <= MOST / 10;
    if (!fits || s->nb != s->nx + s->nc) {
        PyErr_SetString(PyExc_ValueError, "a chain of these sizes cannot be, or is not square");
        return -1;
    }
    s->N = s->ends[s->phases];
    s->nv = s->ne = s->nx + s->nz;
    s->element_unknowns = s->element_equations = s->nx + s->K * s->nv;
    double unknowns = (double)s->N * s->element_unknowns + s->nx + s->nc;
    if (unknowns > 2e9) {
        PyErr_SetString(PyExc_ValueError, "a chain of these sizes cannot be");
        return -1;
    }
    s->unknowns = s->equations = s->N * s->element_unknowns + s->nx + s->nc;
    size_t count = (size_t)s->K * (s->K + 2);
    Held held = {0};
    double *numbers = held_numbers(&held, tableau, count, 0, "tableau");
    if (numbers && (s->a = allocate(count, sizeof(double)))) {
        memcpy(s->a, numbers, count * sizeof(double));
        s->b = s->a + s->K * s->K;
        s->c = s->b + s->K;
    } else if (numbers)
        PyErr_NoMemory();
    held_release(&held);
    return PyErr_Occurred() ? -1 : 0;
}

static PyObject *chain_new(PyTypeObject *type, PyObject *args, PyObject *Py_UNUSED(keywords))
{
    PyObject *ends, *tableau, *q, *r, *programs;
    ChainObject *self = (ChainObject *)type->tp_alloc(type, 0);
    if (!self)
        return NULL;
    Chain *s = &self->chain;
    if (PyArg_ParseTuple(args, "O(iiiiiii)OOOO!", &ends, &s->K, &s->nx, &s->nz, &s->nc, &s->nb,
                         &s->nk, &s->nt, &tableau, &q, &r, &PyTuple_Type, &programs) &&
        !take_sizes(s, ends, tableau) && !take_order(s, q, r) && !take_programs(self, programs))
        return (PyObject *)self;
    Py_DECREF(self);
    return NULL;
}

PyTypeObject ChainType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "ribbonopt.kernel._compiled.Chain",
    .tp_doc = "Chain(ends, sizes, tableau, q, r, programs): one discretised problem.",
    .tp_basicsize = sizeof(ChainObject),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_new = chain_new,
    .tp_dealloc = chain_dealloc,
    .tp_methods = chain_methods,
};
