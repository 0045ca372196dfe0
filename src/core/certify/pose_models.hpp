// The platform's pose in a box of coordinates or on a piece of a path, as models.
#pragma once

#include "certify/elementary.hpp"
#include "certify/task.hpp"
#include "model/motion.hpp"

namespace flexapod {

using certify_task::Box;

/// What the boxes of all lanes say: member(box).
template <class Lane, class Member> Lane of_lanes(const Box* const (&boxes)[Lane::lanes], Member&& member) {
  double values[Lane::lanes];
  for (int l = 0; l < Lane::lanes; ++l) values[l] = member(*boxes[l]);
  return Lane::load(values);
}

/// The coordinate i as variable v: middle + half u covers all between the two ends.
template <class T> T coordinate(const Box* const (&boxes)[T::Number::lanes], int i, int v) {
  using Lane = typename T::Number;
  const Lane low = of_lanes<Lane>(boxes, [&](const Box& b) { return b.low[i]; });
  const Lane high = of_lanes<Lane>(boxes, [&](const Box& b) { return b.high[i]; });
  T x(0.5 * (low + high));
  x.c[1 + v] = max(high - x.c[0], x.c[0] - low);
  x.r = rounding::unit * (abs(low) + abs(high)) + rounding::least;
  return x;
}

/// The pose of a platform in a box.
template <class T> Pose<T> box_pose(const Box* const (&boxes)[T::Number::lanes]) {
  const auto x = [&](int i) { return coordinate<T>(boxes, i, i); };
  const SinCosModel<T> roll(x(3)), pitch(x(4)), yaw(x(5));
  return {{x(0), x(1), x(2)}, roll_pitch_yaw<T>({roll.sin, pitch.sin, yaw.sin}, {roll.cos, pitch.cos, yaw.cos})};
}

/// sum (-s)^k / (2k + first)!, k from 0: sine and versine of a turn with s = |e|^2.
template <class T> T turn_series(const T& s, int first) {
  using Lane = typename T::Number;
  constexpr int terms = 20;
  double factor[terms + 1];
  factor[0] = first == 1 ? 1.0 : 0.5;
  for (int k = 1; k <= terms; ++k) factor[k] = -factor[k - 1] / ((2.0 * k + first - 1.0) * (2.0 * k + first));
  T sum(factor[terms - 1]);
  for (int k = terms - 2; k >= 0; --k) sum = factor[k] + sum * s;
  const Lane reach = (abs(s.c[0]) + s.variation()) * rounding::up;
  Lane rest(2.0 * std::abs(factor[terms])), size(0.0);  // the terms left out fall by more than half each
  for (int k = terms - 1; k >= 0; --k) rest *= reach, size = size * reach + std::abs(factor[k]);
  rest = select(reach < 100.0, rest, Lane(std::numeric_limits<double>::infinity()));
  sum.r = (sum.r + rest + rounding::unit * size) * rounding::up;
  return sum;
}

/// The pose of a platform on a piece of a path.
template <class T> Pose<T> path_pose(const certify_task::Task& task, const Box* const (&boxes)[T::Number::lanes]) {
  using Lane = typename T::Number;
  const T s = coordinate<T>(boxes, 0, 0);
  T q[6];
  for (int i = 0; i < 6; ++i) {
    const auto power = [&](int k) {
      return of_lanes<Lane>(boxes, [&](const Box& b) { return task.pieces[(6 * b.piece + i) * task.powers + k]; });
    };
    q[i] = T(power(task.powers - 1));
    for (int k = task.powers - 2; k >= 0; --k) q[i] = power(k) + q[i] * s;
  }
  const Vec3<T> e(q[3], q[4], q[5]);
  const T angle2 = dot(e, e);
  Mat3<double> middle;
  for (int r = 0; r < 3; ++r) middle.row[r] = {task.middle[3 * r], task.middle[3 * r + 1], task.middle[3 * r + 2]};
  Mat3<T> R = rotation(e, angle2, turn_series(angle2, 1), turn_series(angle2, 2)) * middle;
  for (Vec3<T>& row : R.row)  // `middle` is a rotation but for its own roundings: this holds the true one as well
    for (T* x : {&row.x, &row.y, &row.z}) x->r += 4.0 * rounding::unit;
  return {{q[0], q[1], q[2]}, R};
}

}  // namespace flexapod
