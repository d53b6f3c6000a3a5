/* Programs for Python. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include "kernel.h"
#include "objects.h"

static void program_free(PyObject *self)
{
    Program *p = &((ProgramObject *)self)->program;
    release(p->sizes_in);
    release(p->sizes_out);
    release(p->code);
    Py_TYPE(self)->tp_free(self);
}

/* Whether an instruction reads and writes within what there is. */
static int within(const Program *p, const Instruction *i)
{
    if (i->op < 0 || i->op >= OP_COUNT || i->out < 0 || i->a < 0 || i->b < 0)
        return 0;
    if (i->op == OP_INPUT)
        return i->out < p->work && i->b < p->inputs && i->a < p->sizes_in[i->b];
    if (i->op == OP_OUTPUT)
        return i->a < p->work && i->b < p->outputs && i->out < p->sizes_out[i->b];
    return i->out < p->work && i->a < p->work && i->b < p->work;
}

static int program_fill(Program *p, const double *code)
{
    for (int k = 0; k < p->count; k++, code += 5) {
        for (int j = 0; j < 4; j++)
            if (!(code[j] >= 0 && code[j] <= MOST && code[j] == (int)code[j]))
                return -1;
        Instruction i = {(int)code[0], (int)code[1], (int)code[2], (int)code[3], code[4]};
        if (!within(p, &i))
            return -1;
        p->code[k] = i;
    }
    return 0;
}

static PyObject *program_new(PyTypeObject *type, PyObject *args, PyObject *Py_UNUSED(keywords))
{
    PyObject *code, *in, *out;
    Py_ssize_t count;
    int work;
    if (!PyArg_ParseTuple(args, "OniOO", &code, &count, &work, &in, &out))
        return NULL;
    if (count < 0 || count > MOST || work < 1 || work > MOST) {
        PyErr_SetString(PyExc_ValueError, "a program of this size cannot be");
        return NULL;
    }
    ProgramObject *self = (ProgramObject *)type->tp_alloc(type, 0);
    if (!self)
        return NULL;
    Program *p = &self->program;
    Held held = {0};
    p->count = (int)count;
    p->work = work;
    double *numbers = NULL;
    if ((p->sizes_in = integers(in, &p->inputs, "sizes of inputs")) &&
        (p->sizes_out = integers(out, &p->outputs, "sizes of outputs")) &&
        (numbers = held_numbers(&held, code, (size_t)count * 5, 0, "code"))) {
        p->code = allocate(count, sizeof(Instruction));
        if (!p->code)
            PyErr_NoMemory();
        else if (p->inputs > MOST_ARRAYS || p->outputs > MOST_ARRAYS || program_fill(p, numbers))
            PyErr_SetString(PyExc_ValueError, "code: an instruction beyond what there is");
    }
    held_release(&held);
    if (PyErr_Occurred()) {
        Py_DECREF(self);
        return NULL;
    }
    return (PyObject *)self;
}

/* Read (count, mask, *inputs, *outputs) and find work; what is held is to be released in any case.
 * Of steps that follow one another all share the first input. -1: an error. */
static int take_arguments(const Program *p, PyObject *const *args, Py_ssize_t given, int chained,
                          Py_ssize_t *count, long *shared, Held *held, double **data, double **work)
{
    if (given != 2 + p->inputs + p->outputs) {
        PyErr_Format(PyExc_TypeError, "expected a count, a mask, %d inputs and %d outputs",
                     p->inputs, p->outputs);
        return -1;
    }
    *count = PyLong_AsSsize_t(args[0]);
    *shared = PyLong_AsLong(args[1]) | chained;
    if (PyErr_Occurred())
        return -1;
    if (*count < 0 || *count > MOST) {
        PyErr_Format(PyExc_ValueError, "count: found %zd, expected 0 to %d", *count, MOST);
        return -1;
    }
    for (int i = 0; i < p->inputs + p->outputs; i++) {
        int output = i >= p->inputs, fixed = !output && *shared >> i & 1;
        size_t size = output ? p->sizes_out[i - p->inputs] : p->sizes_in[i];
        size_t expected = fixed ? size : size * (size_t)*count;
        char name[32];
        PyOS_snprintf(name, sizeof name, "argument %d", i);
        if (!(data[i] = held_numbers(held, args[2 + i], expected, output, name)))
            return -1;
    }
    if (!(*work = allocate((size_t)p->work * LANES, sizeof(double)))) {
        PyErr_NoMemory();
        return -1;
    }
    return 0;
}

static PyObject *program_map(PyObject *self, PyObject *const *args, Py_ssize_t given)
{
    const Program *p = &((ProgramObject *)self)->program;
    Py_ssize_t count;
    long shared;
    Held held = {0};
    double *data[2 * MOST_ARRAYS], *work = NULL;
    int failed = take_arguments(p, args, given, 0, &count, &shared, &held, data, &work);
    const double *in[MOST_ARRAYS * LANES];
    double *out[MOST_ARRAYS * LANES];
    for (Py_ssize_t at = 0; !failed && at < count; at += LANES) {
        int lanes = count - at < LANES ? (int)(count - at) : LANES;
        for (int l = 0; l < LANES; l++) {
            size_t place = at + (l < lanes ? l : 0);
            for (int i = 0; i < p->inputs; i++)
                in[i * LANES + l] = data[i] + (shared >> i & 1 ? 0 : place * p->sizes_in[i]);
            for (int i = 0; i < p->outputs; i++)
                out[i * LANES + l] = data[p->inputs + i] + place * p->sizes_out[i];
        }
        program_run(p, lanes, in, out, work);
    }
    release(work);
    held_release(&held);
    if (failed)
        return NULL;
    Py_RETURN_NONE;
}

/* x after each of many steps: the first input is what the step before put out. */
static PyObject *program_accumulate(PyObject *self, PyObject *const *args, Py_ssize_t given)
{
    const Program *p = &((ProgramObject *)self)->program;
    if (p->outputs != 1 || p->inputs < 1 || p->sizes_in[0] != p->sizes_out[0]) {
        PyErr_SetString(PyExc_ValueError, "a step puts out what it takes first, and that alone");
        return NULL;
    }
    Py_ssize_t count;
    long shared;
    Held held = {0};
    double *data[2 * MOST_ARRAYS], *work = NULL;
    int failed = take_arguments(p, args, given, 1, &count, &shared, &held, data, &work);
    const double *in[MOST_ARRAYS * LANES] = {0};
    double *out[LANES] = {0};
    for (Py_ssize_t at = 0; !failed && at < count; at++) {
        for (int i = 1; i < p->inputs; i++)
            in[i * LANES] = data[i] + (shared >> i & 1 ? 0 : at * p->sizes_in[i]);
        out[0] = data[p->inputs] + at * p->sizes_out[0];
        in[0] = at ? out[0] - p->sizes_out[0] : data[0];
        program_run(p, 1, in, out, work);
    }
    release(work);
    held_release(&held);
    if (failed)
        return NULL;
    Py_RETURN_NONE;
}

static PyMethodDef program_methods[] = {
    {"accumulate", (PyCFunction)(void (*)(void))program_accumulate, METH_FASTCALL,
     "accumulate(count, mask, *inputs, output): steps, each from what the one before put out."},
    {"map", (PyCFunction)(void (*)(void))program_map, METH_FASTCALL,
     "map(count, mask, *inputs, *outputs): run at points; inputs in the mask are shared."},
    {NULL, NULL, 0, NULL}};

PyTypeObject ProgramType = {
    PyVarObject_HEAD_INIT(NULL, 0).tp_name = "ribbonopt.kernel._compiled.Program",
    .tp_doc = "Program(code, count, work, sizes_in, sizes_out): an instruction list.",
    .tp_basicsize = sizeof(ProgramObject),
    .tp_flags = Py_TPFLAGS_DEFAULT,
    .tp_new = program_new,
    .tp_dealloc = program_free,
    .tp_methods = program_methods,
};
