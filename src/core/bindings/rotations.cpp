// Rotations as Python sees them: checks and conversions of many, on several threads.
#include "bindings/arrays.hpp"
#include "bindings/bind.hpp"
#include "bindings/unlocked.hpp"
#include "model/angles.hpp"
#include "model/motion.hpp"
#include "threads/parallel_for.hpp"

namespace flexapod {
namespace {

/// Calls work(i) for all i < n without Python's lock.
template <class Work> void for_each(size_t n, int threads, const Work& work) {
  const Unlocked unlocked;
  in_blocks(n, 8192, threads, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) work(i);
  });
}

/// Whether it is true of all i < n.
template <class Holds> bool all_of(size_t n, int threads, const Holds& holds) {
  const Unlocked unlocked;
  std::atomic<bool> all{true};
  in_blocks(n, 8192, threads, [&](size_t first, size_t last) {
    bool block = true;
    for (size_t i = first; i < last; ++i) block &= holds(i);
    if (!block) all = false;
  });
  return all;
}

bool all_finite(const Input& numbers, int threads) {
  const double* x = numbers.data();
  return all_of(numbers.size(), threads,
                [&](size_t i) { return std::abs(x[i]) <= std::numeric_limits<double>::max(); });
}

constexpr double rounding = 1e-9;  // of the entries of R R^T

bool all_rotate(const Input& matrices, int threads) {
  const size_t n = matrices.size() / 9;
  const auto* R = reinterpret_cast<const Mat3<double>*>(rows(matrices, n, 9, "matrices"));
  return all_of(n, threads, [&](size_t i) {
    const auto& [x, y, z] = R[i].row;
    const double skew[] = {dot(x, x) - 1.0, dot(y, y) - 1.0, dot(z, z) - 1.0, dot(x, y), dot(x, z), dot(y, z)};
    bool holds = dot(x, cross(y, z)) > 0;
    for (const double entry : skew) holds &= std::abs(entry) < rounding;
    return holds;
  });
}

bool all_of_length_one(const Input& quaternions, int threads) {
  const size_t n = quaternions.size() / 4;
  const double* q = rows(quaternions, n, 4, "quaternions");
  return all_of(n, threads, [&](size_t i) {
    double square = 0;
    for (size_t k = 4 * i; k < 4 * i + 4; ++k) square += q[k] * q[k];
    return std::abs(square - 1.0) < rounding;
  });
}

/// Matrices (n, 9) of quaternions with their scalar last.
nb::object matrices_of_quaternions(const Input& quaternions, int threads) {
  const size_t n = quaternions.size() / 4;
  const double* q = rows(quaternions, n, 4, "quaternions");
  Array<double> found({n, 9});
  auto* R = reinterpret_cast<Mat3<double>*>(found.data());
  for_each(n, threads,
           [&](size_t i) { R[i] = quaternion_rotation(q[4 * i + 3], {q[4 * i], q[4 * i + 1], q[4 * i + 2]}); });
  return numpy(std::move(found));
}

/// Matrices (n, 9) of roll, pitch, yaw.
nb::object matrices_of_angles(const Input& angles, int threads) {
  const size_t n = angles.size() / 3;
  const auto* rpy = reinterpret_cast<const Vec3<double>*>(rows(angles, n, 3, "angles"));
  Array<double> found({n, 9});
  auto* R = reinterpret_cast<Mat3<double>*>(found.data());
  for_each(n, threads, [&](size_t i) {
    const auto& [roll, pitch, yaw] = rpy[i];
    R[i] = roll_pitch_yaw<double>({std::sin(roll), std::sin(pitch), std::sin(yaw)},
                                  {std::cos(roll), std::cos(pitch), std::cos(yaw)});
  });
  return numpy(std::move(found));
}

/// Roll, pitch, yaw (n, 3) of matrices.
nb::object angles_of_matrices(const Input& matrices, int threads) {
  const size_t n = matrices.size() / 9;
  const auto* R = reinterpret_cast<const Mat3<double>*>(rows(matrices, n, 9, "matrices"));
  Array<double> found({n, 3});
  auto* rpy = reinterpret_cast<Vec3<double>*>(found.data());
  for_each(n, threads, [&](size_t i) { rpy[i] = roll_pitch_yaw_of(R[i]); });
  return numpy(std::move(found));
}

}  // namespace

void bind_rotations(nb::module_& m) {
  m.def("all_finite", &all_finite);
  m.def("all_rotate", &all_rotate);
  m.def("all_of_length_one", &all_of_length_one);
  m.def("matrices_of_quaternions", &matrices_of_quaternions);
  m.def("matrices_of_angles", &matrices_of_angles);
  m.def("angles_of_matrices", &angles_of_matrices);
}

}  // namespace flexapod
