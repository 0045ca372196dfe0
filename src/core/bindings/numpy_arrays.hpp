// NumPy's arrays of float64 read and made where every tenth of a microsecond counts, by NumPy's own C interface: through
// Python, a buffer or a new array takes two. What is used here, two places of its table of functions and the members of an
// array, is its binary interface, which it keeps (pybind11 relies on it too): the core is built without NumPy.
#pragma once

#include <nanobind/nanobind.h>

#include <cstring>
#include <initializer_list>

namespace flexapod {

namespace nb = nanobind;

/// An array as NumPy lays it out.
struct ArrayLayout {
  PyObject_HEAD char* data;
  int ndim;
  Py_ssize_t *shape, *strides;  // strides in bytes
  PyObject *base, *dtype;
};

/// What is taken from NumPy once.
class ArrayInterface {
  static constexpr int new_at = 93, dtype_at = 45, float64 = 12;  // PyArray_New, PyArray_DescrFromType, NPY_DOUBLE
  using New = PyObject* (*)(PyTypeObject*, int, const Py_ssize_t*, int, const Py_ssize_t*, void*, int, int, PyObject*);
  using Dtype = PyObject* (*)(int);
  New make_;

  ArrayInterface() {
    nb::object core = nb::module_::import_("numpy._core._multiarray_umath");
    void** functions = static_cast<void**>(PyCapsule_GetPointer(nb::object(core.attr("_ARRAY_API")).ptr(), nullptr));
    if (functions == nullptr) throw nb::python_error();
    make_ = reinterpret_cast<New>(functions[new_at]);
    type = reinterpret_cast<PyTypeObject*>(nb::object(core.attr("ndarray")).release().ptr());
    dtype = reinterpret_cast<Dtype>(functions[dtype_at])(float64);
  }

 public:
  PyTypeObject* type;  // of arrays
  PyObject* dtype;     // float64

  static const ArrayInterface& get() {
    static const ArrayInterface* const once = new ArrayInterface;  // stays to the end of the process, as NumPy does
    return *once;
  }
  nb::object make(int ndim, const Py_ssize_t* shape) const {
    PyObject* made = make_(type, ndim, shape, float64, nullptr, nullptr, 0, 0, nullptr);
    if (made == nullptr) throw nb::python_error();
    return nb::steal(made);
  }
};

/// What an object holds, if it is a plain array of float64 (no subclass, which may mean something else by it).
class ArrayView {
  const ArrayLayout* array_ = nullptr;

 public:
  explicit ArrayView(PyObject* x) {
    const ArrayInterface& numpy = ArrayInterface::get();
    if (Py_TYPE(x) != numpy.type) return;
    const auto* array = reinterpret_cast<const ArrayLayout*>(x);
    if (array->dtype == numpy.dtype) array_ = array;
  }

  /// Whether it is an array of this shape.
  bool has_shape(std::initializer_list<Py_ssize_t> shape) const {
    if (array_ == nullptr || array_->ndim != static_cast<int>(shape.size())) return false;
    return std::equal(shape.begin(), shape.end(), array_->shape);
  }
  void copy_to(double* to) const {
    const Py_ssize_t rows = array_->ndim == 1 ? 1 : array_->shape[0], columns = array_->shape[array_->ndim - 1];
    const Py_ssize_t across = array_->strides[array_->ndim - 1];
    for (Py_ssize_t i = 0; i < rows; ++i) {
      const char* from = array_->data + i * array_->strides[0];
      for (Py_ssize_t j = 0; j < columns; ++j) std::memcpy(to++, from + j * across, sizeof(double));
    }
  }
};

/// A new array of a shape, with numbers that `fill(double*)` sets.
template <class Fill> nb::object new_array(std::initializer_list<Py_ssize_t> shape, Fill&& fill) {
  nb::object array = ArrayInterface::get().make(static_cast<int>(shape.size()), shape.begin());
  fill(reinterpret_cast<double*>(reinterpret_cast<ArrayLayout*>(array.ptr())->data));
  return array;
}

}  // namespace flexapod
