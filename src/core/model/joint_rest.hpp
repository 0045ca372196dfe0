// The pose at which joints and suspension are unstressed.
#pragma once

#include "model/angles.hpp"
#include "model/leg.hpp"

namespace flexapod {

template <class T> Pose<T> rest_pose(const Design<T>& d) { return {d.rest_position, d.rest_matrix}; }

/// The axes of a leg where its joints are unstressed, as base and platform carry them; the rest pose is in the base frame.
template <class T> struct JointRest {
  Mat3<T> in_base, in_platform;  // rows: along the leg, y, z of its axes
  T tilt;                        // of the leg out of the plane normal to its universal axis, rad

  JointRest() = default;
  JointRest(const Design<T>& d, int i) : JointRest(d, rest_pose(d), i) {}
  /// d: a design, or what has its places.
  template <class D, class U> JointRest(const D& d, const Pose<U>& rest, int i) {
    const LegAxes<T> leg(rest.t + rest.R * d.p[i] - d.b[i], d.k[i], Joint::universal);
    in_base = leg.axes;
    for (int r = 0; r < 3; ++r) in_platform.row[r] = transposed(rest.R, leg.axes.row[r]);
    tilt = signed_angle(leg.tau, T(1.0));
  }
};

}  // namespace flexapod
