// Poses as functions of a small displacement, for exact derivatives.
#pragma once

#include "model/motion.hpp"
#include "numbers/dual.hpp"

namespace flexapod {

/// Three dual variables of value zero, with derivatives at `first` and the two after it.
template <class D> Vec3<D> variables(int first) {
  return {D::variable(0.0, first), D::variable(0.0, first + 1), D::variable(0.0, first + 2)};
}
/// A pose whose small displacement (translation, rotation vector) is six dual variables.
template <class D> Pose<D> displaceable(const Pose<double>& pose, int first) {
  return displaced(pose, variables<D>(first), variables<D>(first + 3));
}
/// A pose that does not depend on the variables.
template <class D> Pose<D> constant(const Pose<double>& pose) { return displaced<D>(pose, {}, {}); }

}  // namespace flexapod
