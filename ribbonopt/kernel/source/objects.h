/* What the objects of the kernel share on the side of Python. */
#ifndef RIBBONOPT_OBJECTS_H
#define RIBBONOPT_OBJECTS_H

#include "kernel.h"

#define MOST 100000000  /* of any number that counts or indexes: products of two fit 64 bits */
#define MOST_ARRAYS 8   /* inputs or outputs of a program */
#define MOST_HELD 16
#define MOST_STATES 10000 /* also of constants, stages and phases */

typedef struct {
    Py_buffer views[MOST_HELD];
    int count;
} Held;

/* The numbers of an array that must have `expected` of them, held until released; NULL: an error. */
double *held_numbers(Held *held, PyObject *object, size_t expected, int writable,
                     const char *name);
void held_release(Held *held);
/* New array of the whole numbers of a sequence, 0 to MOST; NULL: an error. */
int *integers(PyObject *sequence, int *count, const char *name);

typedef struct {
    PyObject_HEAD
    Program program;
} ProgramObject;

typedef struct {
    PyObject_HEAD
    Chain chain;
    PyObject *programs; /* keeps them alive */
} ChainObject;

typedef struct {
    PyObject_HEAD
    Factors *factors;
    ChainObject *chain;
} FactorsObject;

extern PyTypeObject ProgramType, ChainType, FactorsType;
extern PyMethodDef chain_methods[];

#endif
