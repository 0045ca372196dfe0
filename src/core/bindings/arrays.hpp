// NumPy arrays in and out of the core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/design.hpp"
#include "model/motion.hpp"

namespace flexapod {

namespace nb = nanobind;
using Input = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

/// A new float64 array; hand it to Python with `array()`.
class Output {
 public:
  explicit Output(std::initializer_list<size_t> shape) : shape_(shape) {
    size_t size = 1;
    for (size_t n : shape_) size *= n;
    data_.reset(new double[size == 0 ? 1 : size]());
  }
  double* data() { return data_.get(); }
  nb::ndarray<nb::numpy, double> array() {
    double* raw = data_.release();
    nb::capsule owner(raw, [](void* p) noexcept { delete[] static_cast<double*>(p); });
    return {raw, shape_.size(), shape_.data(), owner};
  }

 private:
  std::vector<size_t> shape_;
  std::unique_ptr<double[]> data_;
};

/// The input's rows of `width` numbers, one for each of n poses.
inline const double* rows(const Input& input, size_t n, size_t width, const char* name) {
  if (input.size() != n * width)
    throw std::invalid_argument(std::string(name) + " has " + std::to_string(input.size()) + " numbers; " +
                                std::to_string(n) + " rows of " + std::to_string(width) + " are needed");
  return input.data();
}

/// The machine of a design; what is purely geometric is the same for every joint model.
inline Machine<double> machine_of(const Input& design, Joint joint = Joint::universal) {
  const auto* d = reinterpret_cast<const Design<double>*>(rows(design, 1, design_size, "design"));
  return Machine<double>(*d, joint);
}

inline const Motion<double>* motions(const Input& input, size_t n, const char* name) {
  return reinterpret_cast<const Motion<double>*>(rows(input, n, motion_size, name));
}

inline Vec6<double> vec6(const double* x) { return {{x[0], x[1], x[2], x[3], x[4], x[5]}}; }

inline void write(double*& to, const Vec3<double>& v) {
  for (const double x : {v.x, v.y, v.z}) *to++ = x;
}
inline void write(double*& to, const Vec6<double>& v) {
  for (const double x : v.a) *to++ = x;
}
inline void write(double*& to, const Mat6<double>& m) {
  for (const auto& row : m.a)
    for (const double x : row) *to++ = x;
}
inline void write(double*& to, const double (&values)[6]) {
  for (const double x : values) *to++ = x;
}
inline void write(double*& to, const Pose<double>& pose) {
  write(to, pose.t);
  for (const auto& row : pose.R.row) write(to, row);
}

}  // namespace flexapod
