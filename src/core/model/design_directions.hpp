// Values at many poses and their derivatives along directions of a design, as arrays.
#pragma once

#include <span>
#include <vector>

#include "model/design_gradient.hpp"
#include "model/leg_distance.hpp"
#include "model/statics.hpp"
#include "numbers/array.hpp"

namespace flexapod {

/// Values (n, width) and their derivatives (n, width, m).
struct ValueGradient {
  Array<double> value, derivative;

  ValueGradient(size_t n, size_t width, size_t m) : value({n, width}), derivative({n, width, m}) {}
  void clear() {
    std::fill_n(value.data(), value.size(), 0.0);
    std::fill_n(derivative.data(), derivative.size(), 0.0);
  }
  void put(size_t row, size_t column, const Seed& x, size_t first, int count) {
    const size_t width = value.shape()[1], m = derivative.shape()[2];
    value.data()[row * width + column] = x.v;
    std::copy_n(x.d, count, derivative.data() + (row * width + column) * m + first);
  }
};

struct FrequencyGradient {
  Array<double> omega;     // (n, 6)
  Array<double> rayleigh;  // (n, 6, 6, m), see rayleigh_matrix
};

struct LegGradient {
  ValueGradient length;        // (n, 6)
  ValueGradient distance;      // (n, 15 pairs of legs)
  ValueGradient joint_cosine;  // (n, 12: universal, spherical)
  ValueGradient joint_moment;  // (n, 12: universal, spherical), squares of the bending moments of the joints' springs
};

/// A machine at n poses, and m directions in which its design and the poses change.
class DesignDirections {
 public:
  /// directions: (m, design_size). displacements: (n, m, 6) of the poses. home: one motion, or none, and its
  /// displacements (m, 6).
  DesignDirections(const Machine<double>& machine, std::span<const Motion<double>> platforms,
                   std::span<const double> directions, std::span<const double> displacements,
                   std::span<const Motion<double>> home, std::span<const double> home_displacements)
      : machine_(machine),
        platforms_(platforms.begin(), platforms.end()),
        home_(home.begin(), home.end()),
        directions_(directions.begin(), directions.end()),
        displacements_(displacements.begin(), displacements.end()),
        home_displacements_(home_displacements.begin(), home_displacements.end()),
        n_(platforms.size()),
        m_(directions.size() / design_size),
        features_(machine.features) {
    for (size_t k = 0; k < m_; ++k) {  // a spring that is not there yet may come with a direction
      const auto& change = *reinterpret_cast<const Design<double>*>(directions_.data() + k * design_size);
      if (used_size(change) == plain_size) continue;
      features_ = features_ | Features(change);
      numbers_ = design_size;
    }
  }

  FrequencyGradient frequencies() const {
    FrequencyGradient found{Array<double>({n_, 6}), Array<double>({n_, 6, 6, m_})};
    std::vector<Modes> modes(n_);
    for (size_t i = 0; i < n_; ++i) {
      const Pose<double>& pose = platforms_[i].pose;
      modes[i] = natural_modes(machine_, Geometry<double>(machine_.design, pose, Pose<double>()), pose.R,
                               Mat3<double>::identity());
      std::copy_n(modes[i].omega, 6, found.omega.data() + 6 * i);
    }
    for_each([&](const Block& block, const Machine<Seed>& machine, const Geometry<Seed>& g, const Pose<Seed>& pose,
                 size_t i) {
      Seed products[6][6];
      rayleigh_matrix(machine, g, pose.R, modes[i], products);
      for (size_t a = 0; a < 36; ++a)
        std::copy_n(products[a / 6][a % 6].d, block.count, found.rayleigh.data() + (i * 36 + a) * m_ + block.first);
    });
    return found;
  }

  /// H by rows, (n, 36).
  ValueGradient force_transformation() const {
    ValueGradient found(n_, 36, m_);
    for_each([&](const Block& block, const Machine<Seed>&, const Geometry<Seed>& g, const Pose<Seed>&, size_t i) {
      const Mat6<Seed> H = flexapod::force_transformation(g);
      for (size_t a = 0; a < 36; ++a) found.put(i, a, H[a / 6][a % 6], block.first, block.count);
    });
    return found;
  }

  /// K of all springs by rows, (n, 36).
  ValueGradient stiffness() const {
    ValueGradient found(n_, 36, m_);
    for_each([&](const Block& block, const Machine<Seed>& machine, const Geometry<Seed>& g, const Pose<Seed>& pose,
                 size_t i) {
      Mat6<Seed> K =
          with_stiffness(machine, g, [&](const auto& k) { return stiffness_matrix(k, spring_directions(g)); });
      if (machine.features.others()) {
        const Mat6<Seed> others = other_stiffness(machine, g, pose.R, Mat3<Seed>::identity());
        for (size_t a = 0; a < 36; ++a) K[a / 6][a % 6] += others[a / 6][a % 6];
      }
      for (size_t a = 0; a < 36; ++a) found.put(i, a, K[a / 6][a % 6], block.first, block.count);
    });
    return found;
  }

  /// The wrench at the reference point that leg forces hold at rest, (n, 6): weight, springs of joints and suspension.
  ValueGradient held_wrench() const {
    ValueGradient found(n_, 6, m_);
    for_each([&](const Block& block, const Machine<Seed>& machine, const Geometry<Seed>& g, const Pose<Seed>& pose,
                 size_t i) {
      const Vec6<Seed> wrench = inverse_wrench(machine, g, at_rest(pose), at_rest(Pose<Seed>()));
      for (int a = 0; a < 6; ++a) found.put(i, static_cast<size_t>(a), wrench[a], block.first, block.count);
    });
    return found;
  }

  LegGradient legs() const {
    LegGradient found{{n_, 6, m_}, {n_, leg_pairs, m_}, {n_, 12, m_}, {n_, 12, m_}};
    if (!features_.joints) found.joint_moment.clear();
    const SharedJoints shared(machine_.design);
    for_each([&](const Block& block, const Machine<Seed>& machine, const Geometry<Seed>& g, const Pose<Seed>& pose,
                 size_t i) {
      for (size_t a = 0; a < 6; ++a) found.length.put(i, a, norm(g.S[a]), block.first, block.count);
      for_leg_pairs([&](int pair, int a, int b) {
        found.distance.put(i, pair, pair_distance(g, shared, pair, a, b), block.first, block.count);
      });
      Seed angles[2][6];
      joint_cosines(block.seeded, pose, home_.empty() ? nullptr : &block.home, angles);
      for (size_t a = 0; a < 12; ++a) found.joint_cosine.put(i, a, angles[a / 6][a % 6], block.first, block.count);
      if (!machine.features.joints) return;
      squared_moments(machine, g, pose.R, angles);
      for (size_t a = 0; a < 12; ++a) found.joint_moment.put(i, a, angles[a / 6][a % 6], block.first, block.count);
    });
    return found;
  }

 private:
  /// As many directions as derivatives are taken at once.
  struct Block {
    size_t first;
    int count;
    const SeededDesign& seeded;
    Pose<Seed> home;
  };

  /// Calls work(block, machine, geometry, pose, i) for every block of directions at every pose i.
  template <class Work> void for_each(Work&& work) const {
    SeededDesign seeded(machine_.joint, features_, numbers_);
    for (size_t first = 0; first < m_; first += gradient_lanes) {
      const int count = static_cast<int>(std::min<size_t>(gradient_lanes, m_ - first));
      seeded.set(machine_.design, directions_.data() + first * design_size, count);
      Block block{first, count, seeded, {}};
      if (!home_.empty()) block.home = seeded.pose(home_[0].pose, home_displacements_.data() + first * 6);
      for (size_t i = 0; i < n_; ++i) {
        const Pose<Seed> pose = seeded.pose(platforms_[i].pose, displacements_.data() + (i * m_ + first) * 6);
        work(block, seeded.machine, Geometry<Seed>(seeded.machine.design, pose, Pose<Seed>()), pose, i);
      }
    }
  }

  Machine<double> machine_;
  std::vector<Motion<double>> platforms_, home_;
  std::vector<double> directions_, displacements_, home_displacements_;
  size_t n_, m_;
  Features features_;
  int numbers_ = used_size(machine_.design);
};

}  // namespace flexapod
