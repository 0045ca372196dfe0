// A design with what is computed from it once.
#pragma once

#include "model/axial_stiffness.hpp"
#include "model/joint_rest.hpp"

namespace flexapod {

template <class T> struct Machine {
  Design<T> design;
  Joint joint;
  Features features;
  LegInertia<T> inertia[6];
  AxialStiffness<T> axial;
  JointRest<T> rest[6];  // set where joints have springs

  Machine(const Design<T>& d, Joint j) : Machine(d, j, Features(d)) {}
  Machine(const Design<T>& d, Joint j, const Features& f) : design(d), joint(j), features(f) { refresh(); }

  /// One whose numbers are set next; then `refresh`.
  Machine(Joint j, const Features& f) : joint(j), features(f) {}
  /// The same machine over another scalar.
  template <class U> explicit Machine(const Machine<U>& other) : joint(other.joint), features(other.features) {
    const U* from = &other.design.gravity.x;
    T* to = &design.gravity.x;
    for (int i = 0; i < design_size; ++i) to[i] = T(from[i]);
    refresh();
  }

  /// Computes it anew, after a change of the design's numbers that leaves its features.
  void refresh() {
    for (int i = 0; i < 6; ++i) inertia[i] = LegInertia<T>(design.leg[i]);
    axial.set(design, features);
    if (features.joints)
      for (int i = 0; i < 6; ++i) rest[i] = JointRest<T>(design, i);
  }
  /// Axial stiffness of a leg of length L, with the springs in series, N/m.
  template <class U> U stiffness(int i, const U& L) const {
    return features.law == Law::constant ? U(axial.constant[i]) : axial.at(design, features, i, L);
  }
};

}  // namespace flexapod
