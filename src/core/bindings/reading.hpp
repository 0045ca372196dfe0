// Numbers of one call from Python, read and given without a detour: an array of a known shape, or a list or tuple of
// numbers. What is read here is never refused here: who calls takes the long way, which tells what is wrong.
#pragma once

#include "bindings/numpy_arrays.hpp"

namespace flexapod {

inline bool finite(const double* x, int n) {
  double zero = 0;
  for (int i = 0; i < n; ++i) zero += 0.0 * x[i];
  return zero == 0;
}

/// n numbers of a list or a tuple of floats and integers.
inline bool read_sequence(PyObject* x, double* to, Py_ssize_t n) {
  if (!(PyTuple_CheckExact(x) || PyList_CheckExact(x)) || PySequence_Fast_GET_SIZE(x) != n) return false;
  for (Py_ssize_t i = 0; i < n; ++i) {
    PyObject* item = PySequence_Fast_GET_ITEM(x, i);
    if (PyFloat_CheckExact(item)) {
      to[i] = PyFloat_AS_DOUBLE(item);
    } else {
      if (!PyLong_CheckExact(item)) return false;
      to[i] = PyLong_AsDouble(item);
      if (to[i] == -1.0 && PyErr_Occurred()) {
        PyErr_Clear();
        return false;
      }
    }
  }
  return true;
}

/// n numbers of an array (n,), a list or a tuple.
inline bool read_numbers(nb::handle x, double* to, int n) {
  if (read_sequence(x.ptr(), to, n)) return true;
  const ArrayView view(x.ptr());
  if (!view.has_shape({n})) return false;
  view.copy_to(to);
  return true;
}
inline bool read_finite(nb::handle x, double* to, int n) { return read_numbers(x, to, n) && finite(to, n); }

}  // namespace flexapod
