// How the natural frequencies depend on the pose and on the numbers of the design, exactly.
#pragma once

#include <vector>

#include "model/modes.hpp"

namespace flexapod {

/// The numbers of a design, and the place of one of them.
inline const double* numbers_of(const Design<double>& d) { return &d.gravity.x; }
inline int place_of(const Design<double>& d, const double& number) { return static_cast<int>(&number - numbers_of(d)); }

/// Places of the numbers by which derivatives are taken with dual numbers: those of a plain design, of its stiffness law
/// and the suspension's point. By stiffnesses of joints and suspension and by compliances in series omega^2 has
/// derivatives in closed form, and no other number acts on it.
inline std::vector<int> dual_places(const Design<double>& d, const Features& features) {
  std::vector<int> places;
  const auto append = [&](int first, int count) {
    for (int i = 0; i < count; ++i) places.push_back(first + i);
  };
  append(0, plain_size);
  for (const LegSprings<double>& s : d.springs) {
    if (features.law == Law::screw) append(place_of(d, s.fixed), 3);
    if (features.law == Law::hydraulic) append(place_of(d, s.bulk_modulus), 7);
  }
  if (features.law == Law::table)
    for (const Nodes<double>* column : {&d.table_lengths, &d.table_stiffnesses})
      append(place_of(d, column->a[0]), static_cast<int>(d.table_count));
  if (features.suspension) append(place_of(d, d.suspension_point.x), 3);
  return places;
}

/// Derivatives of the six omega^2 by stiffnesses and compliances that need not be there, from how the modes' shapes move
/// the springs: added to rows of zeros.
inline void spring_derivatives(const Machine<double>& machine, const Geometry<double>& g, const Pose<double>& platform,
                               const Pose<double>& base, const Modes& modes, double (*out)[design_size]) {
  const Design<double>& d = machine.design;
  Vec6<double> shape[6];
  for (int m = 0; m < 6; ++m)
    for (int i = 0; i < 6; ++i) shape[m][i] = modes.shape[i][m];
  for (int i = 0; i < 6; ++i) {
    const LegSprings<double>& s = d.springs[i];
    const LegAxes<double> leg(g.S[i], g.k[i], machine.joint);
    const Vec6<double> along = leg_wrench(g.q_p[i], leg.s());
    const double k = machine.stiffness(i, leg.L);
    const JointDirections<double> joint(leg, g.q_p[i], machine.joint);
    const int place[springs_of_joints] = {place_of(d, s.k_u[0]), place_of(d, s.k_u[1]), place_of(d, s.k_s),
                                          place_of(d, s.k_s), place_of(d, s.k_t)};
    for (int m = 0; m < 6; ++m) {
      const double force = k * dot(along, shape[m]);
      out[m][place_of(d, s.series_compliance)] = -force * force;
      for (int j = 0; j < springs_of_joints; ++j) {
        const double rate = dot(joint.d[j], shape[m]);
        out[m][place[j]] += rate * rate;
      }
    }
  }
  for (int m = 0; m < 6; ++m) {
    const Vec6<double> twist = suspension_twist(base.R, platform.R * d.suspension_point, shape[m]);
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c <= r; ++c)
        out[m][place_of(d, d.suspension_stiffness.at(r, c))] = (r == c ? 1.0 : 2.0) * twist[r] * twist[c];
  }
}

/// Derivatives of the six omega^2 by the numbers of the design: row m, one column a number.
inline void design_derivatives(const Machine<double>& machine, const Pose<double>& platform, const Pose<double>& base,
                               const Modes& modes, double (*out)[design_size]) {
  constexpr int lanes = 8;
  using D = Dual<lanes>;
  const Design<double>& design = machine.design;
  const std::vector<int> places = dual_places(design, machine.features);
  Machine<D> seeded(machine);
  D* number = &seeded.design.gravity.x;
  for (int m = 0; m < 6; ++m) std::fill_n(out[m], design_size, 0.0);
  spring_derivatives(machine, Geometry<double>(design, platform, base), platform, base, modes, out);
  const Pose<D> p = constant<D>(platform), b = constant<D>(base);
  for (size_t first = 0; first < places.size(); first += lanes) {
    const int count = static_cast<int>(std::min<size_t>(lanes, places.size() - first));
    for (int i = 0; i < count; ++i) number[places[first + i]].d[i] = 1.0;
    seeded.refresh();
    const Vec6<D> residual = rayleigh_residuals(seeded, Geometry<D>(seeded.design, p, b), p.R, b.R, modes);
    for (int m = 0; m < 6; ++m)
      for (int i = 0; i < count; ++i) out[m][places[first + i]] = residual[m].d[i];
    for (int i = 0; i < count; ++i) number[places[first + i]].d[i] = 0.0;
  }
}

/// Derivatives of the six omega^2 by the platform's displacement (translation, rotation vector): row m.
inline Mat6<double> pose_derivatives(const Machine<double>& machine, const Pose<double>& platform,
                                     const Pose<double>& base, const Modes& modes) {
  using D = Dual<6>;
  const Pose<D> p = displaceable<D>(platform, 0), b = constant<D>(base);
  const Vec6<D> residual = rayleigh_residuals(machine, Geometry<D>(machine.design, p, b), p.R, b.R, modes);
  Mat6<double> out;
  for (int m = 0; m < 6; ++m)
    for (int i = 0; i < 6; ++i) out[m][i] = residual[m].d[i];
  return out;
}

}  // namespace flexapod
