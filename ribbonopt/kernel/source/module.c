/* The kernel for Python. */
#define PY_SSIZE_T_CLEAN
#include <Python.h>

#include "kernel.h"
#include "objects.h"

static PyObject *module_writhe(PyObject *Py_UNUSED(module), PyObject *const *args,
                               Py_ssize_t given)
{
    Py_ssize_t count = given == 2 ? PyLong_AsSsize_t(args[0]) : -1;
    if (PyErr_Occurred())
        return NULL;
    if (count < 0 || count > MOST) {
        PyErr_SetString(PyExc_ValueError, "expected the number of points, and these");
        return NULL;
    }
    Held held = {0};
    double *r = held_numbers(&held, args[1], 3 * (size_t)count, 0, "points");
    double found = r ? writhe(r, (long)count) : 0.0;
    held_release(&held);
    return r ? PyFloat_FromDouble(found) : NULL;
}

static PyMethodDef functions[] = {
    {"writhe", (PyCFunction)(void (*)(void))module_writhe, METH_FASTCALL,
     "writhe(count, points): writhe of the closed polygon through points (count, 3)."},
    {NULL, NULL, 0, NULL}};

static PyModuleDef definition = {
    PyModuleDef_HEAD_INIT,
    .m_name = "_compiled",
    .m_doc = "Compiled twin of the stage functions, the condensed system and Newton's loop.",
    .m_size = -1,
    .m_methods = functions,
};

PyMODINIT_FUNC PyInit__compiled(void)
{
    static const char *const names[] = {
#define TEXT(name) "OP_" #name,
        OPS(TEXT)};
    PyObject *module = PyModule_Create(&definition), *operations = PyDict_New();
    if (!module || !operations)
        return NULL;
    for (int i = 0; i < OP_COUNT; i++) {
        PyObject *number = PyLong_FromLong(i);
        if (!number || PyDict_SetItemString(operations, names[i], number))
            return NULL;
        Py_DECREF(number);
    }
    if (PyType_Ready(&ProgramType) || PyType_Ready(&ChainType) || PyType_Ready(&FactorsType) ||
        PyModule_AddObject(module, "OPERATIONS", operations) ||
        PyModule_AddIntConstant(module, "INTERFACE", INTERFACE))
        return NULL;
    Py_INCREF(&ProgramType);
    Py_INCREF(&ChainType);
    if (PyModule_AddObject(module, "Program", (PyObject *)&ProgramType) ||
        PyModule_AddObject(module, "Chain", (PyObject *)&ChainType))
        return NULL;
    return module;
}
