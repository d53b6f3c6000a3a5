/* The door: every array and number is checked here, beyond it they are trusted. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include "kernel.h"
#include "objects.h"

double *held_numbers(Held *held, PyObject *object, size_t expected, int writable, const char *name)
{
    Py_buffer *view = &held->views[held->count];
    if (held->count == MOST_HELD) {
        PyErr_SetString(PyExc_SystemError, "too many arrays");
        return NULL;
    }
    int flags = PyBUF_C_CONTIGUOUS | PyBUF_FORMAT | (writable ? PyBUF_WRITABLE : 0);
    if (PyObject_GetBuffer(object, view, flags))
        return NULL;
    held->count++;
    if (!view->format || strcmp(view->format, "d") || view->itemsize != sizeof(double)) {
        PyErr_Format(PyExc_TypeError, "%s is expected to be of numbers in double precision", name);
        return NULL;
    }
    if ((size_t)view->len != expected * sizeof(double)) {
        PyErr_Format(PyExc_ValueError, "%s is expected to have %zu numbers, found %zd", name, expected,
                     view->len / view->itemsize);
        return NULL;
    }
    static double none; /* where an empty array has no place */
    return view->buf ? view->buf : &none;
}

void held_release(Held *held)
{
    while (held->count)
        PyBuffer_Release(&held->views[--held->count]);
}

int *integers(PyObject *sequence, int *count, const char *name)
{
    PyObject *items = PySequence_Tuple(sequence); /* a list may change while it is read */
    if (!items)
        return NULL;
    Py_ssize_t n = PyTuple_GET_SIZE(items);
    int *result = n > MOST ? NULL : allocate(n, sizeof(int));
    if (!result)
        PyErr_NoMemory();
    for (Py_ssize_t i = 0; result && i < n; i++) {
        long value = PyLong_AsLong(PyTuple_GET_ITEM(items, i));
        if (PyErr_Occurred() || value < 0 || value > MOST) {
            if (!PyErr_Occurred())
                PyErr_Format(PyExc_ValueError, "%s: found %ld, expected 0 to %d", name, value,
                             MOST);
            release(result);
            result = NULL;
        } else
            result[i] = (int)value;
    }
    Py_DECREF(items);
    *count = (int)n;
    return result;
}
