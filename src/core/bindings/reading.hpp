// Numbers of one call from Python, read and given without a detour: an array of a known shape, or a list or tuple of
// numbers. What is read here is never refused here: who calls takes the long way, which tells what is wrong.
#pragma once

#include <nanobind/nanobind.h>

#include <cmath>
#include <cstring>
#include <initializer_list>

namespace flexapod {

namespace nb = nanobind;

/// An attribute of NumPy, fetched once and kept.
inline PyObject* of_numpy(const char* name) {
  return nb::object(nb::module_::import_("numpy").attr(name)).release().ptr();
}

/// A view of an object's memory, if it is a plain array of float64 (no subclass, which may mean something else by it).
class ArrayView {
  Py_buffer view_{};
  bool open_ = false;

 public:
  explicit ArrayView(PyObject* x, bool writable = false) {
    static PyObject* const array = of_numpy("ndarray");
    static PyObject* const float64 = nb::object(nb::module_::import_("numpy").attr("dtype")("float64")).release().ptr();
    static PyObject* const dtype = PyUnicode_InternFromString("dtype");
    if (reinterpret_cast<PyObject*>(Py_TYPE(x)) != array) return;
    PyObject* kind = PyObject_GetAttr(x, dtype);  // NumPy would write a view's format anew each time
    Py_XDECREF(kind);
    if (kind != float64 || PyObject_GetBuffer(x, &view_, writable ? PyBUF_STRIDED : PyBUF_STRIDED_RO) != 0) {
      PyErr_Clear();
      return;
    }
    open_ = true;
  }
  ArrayView(const ArrayView&) = delete;
  ArrayView& operator=(const ArrayView&) = delete;
  ~ArrayView() {
    if (open_) PyBuffer_Release(&view_);
  }

  /// Whether it is an array of this shape.
  bool has_shape(std::initializer_list<Py_ssize_t> shape) const {
    if (!open_ || view_.ndim != static_cast<int>(shape.size())) return false;
    return std::equal(shape.begin(), shape.end(), view_.shape);
  }
  void copy_to(double* to) const {
    const auto* from = static_cast<const char*>(view_.buf);
    if (view_.ndim == 1) {
      for (Py_ssize_t i = 0; i < view_.shape[0]; ++i) std::memcpy(to++, from + i * view_.strides[0], sizeof(double));
      return;
    }
    for (Py_ssize_t i = 0; i < view_.shape[0]; ++i)
      for (Py_ssize_t j = 0; j < view_.shape[1]; ++j)
        std::memcpy(to++, from + i * view_.strides[0] + j * view_.strides[1], sizeof(double));
  }
  double* data() const { return static_cast<double*>(view_.buf); }
};

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

/// A new array of a shape, with numbers that `fill(double*)` sets.
template <class Fill> nb::object new_array(std::initializer_list<int> shape, Fill&& fill) {
  static PyObject* const empty = of_numpy("empty");
  PyObject* sizes = PyTuple_New(static_cast<Py_ssize_t>(shape.size()));
  if (sizes == nullptr) throw nb::python_error();
  Py_ssize_t i = 0;
  for (const int n : shape) PyTuple_SET_ITEM(sizes, i++, PyLong_FromLong(n));
  PyObject* arguments[] = {nullptr, sizes};
  PyObject* made = PyObject_Vectorcall(empty, arguments + 1, 1 | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
  Py_DECREF(sizes);
  if (made == nullptr) throw nb::python_error();
  nb::object array = nb::steal(made);
  const ArrayView view(made, true);
  fill(view.data());
  return array;
}

}  // namespace flexapod
