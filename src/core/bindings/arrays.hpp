// NumPy arrays in and out of the core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <span>
#include <stdexcept>
#include <string>
#include <tuple>

#include "model/batch.hpp"
#include "numbers/array.hpp"

namespace flexapod {

namespace nb = nanobind;
using namespace nb::literals;
using Input = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

/// The input's rows of `width` numbers, one for each of n states.
inline const double* rows(const Input& input, size_t n, size_t width, const char* name) {
  if (input.size() != n * width)
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(input.size()) + " numbers; " +
                                std::to_string(n) + " rows of " + std::to_string(width) + " are needed");
  return input.data();
}
inline const Motion<double>* motions(const Input& input, size_t n, const char* name) {
  return reinterpret_cast<const Motion<double>*>(rows(input, n, motion_size, name));
}
inline const Vec6<double>* sixes(const Input& input, size_t n, const char* name) {
  return reinterpret_cast<const Vec6<double>*>(rows(input, n, 6, name));
}
inline std::span<const double> span(const Input& input) { return {input.data(), input.size()}; }

/// The machine of a design; what is purely geometric is the same for every joint model.
inline Machine<double> machine_of(const Input& design, Joint joint = Joint::universal) {
  const auto* d = reinterpret_cast<const Design<double>*>(rows(design, 1, design_size, "design"));
  return Machine<double>(*d, joint);
}
inline States states_of(const Input& platform, const Input& base) {
  const size_t n = platform.size() / motion_size;
  return {n, motions(platform, n, "platform"), motions(base, n, "base")};
}

/// A NumPy array that takes over the core's.
template <class T> nb::object numpy(Array<T>&& array) {
  const std::vector<size_t> shape = array.shape();
  T* data = array.release().release();
  nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, T>(data, shape.size(), shape.data(), owner));
}
inline nb::object numpy(Rest end) { return nb::cast(end); }
template <class... T> nb::tuple numpy(std::tuple<T...>&& results) {
  return std::apply([](auto&... each) { return nb::make_tuple(numpy(std::move(each))...); }, results);
}

/// A read-only attribute that shows a member of a class, as an array that keeps the object alive.
template <class C, class T> void show(nb::class_<C>& to, const char* name, Array<T> C::* member) {
  to.def_prop_ro(name, [member](nb::handle self) {
    const Array<T>& array = nb::cast<const C&>(self).*member;
    return nb::ndarray<nb::numpy, T>(array.data(), array.shape().size(), array.shape().data(), self);
  });
}

}  // namespace flexapod
