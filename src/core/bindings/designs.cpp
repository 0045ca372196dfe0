// Searches over designs as Python sees them.
#include "bindings/designs.hpp"

#include "bindings/parallel_for.hpp"
#include "bindings/sweep.hpp"
#include "model/design_gradient.hpp"

namespace flexapod {
namespace {

/// (designs, poses, modes) or, paired, (designs, modes).
nb::object sweep_designs(const Input& designs, Joint joint, const Input& poses, bool paired, int modes, int threads) {
  if (threads < 1) throw std::invalid_argument("threads is " + std::to_string(threads) + "; it must be >= 1");
  if (modes != 1 && modes != 6) throw std::invalid_argument("modes must be 1 or 6");
  const size_t n = designs.size() / design_size, k = poses.size() / 12;
  rows(poses, paired ? n : k, 12, "poses");
  sweep_task::DesignTask task{};
  task.designs = rows(designs, n, design_size, "designs");
  task.joint = joint;
  task.poses = poses.data();
  task.poses_count = k;
  task.paired = paired;
  task.modes = modes;
  Output omega({n, paired ? size_t{1} : k, static_cast<size_t>(modes)});
  task.omega = omega.data();
  {
    nb::gil_scoped_release release;
    const sweep_task::Kernel& kernel = kernel_in_use();
    in_blocks(n, 256, threads, [&](size_t first, size_t last) { kernel.sweep_designs(task, first, last); });
  }
  return nb::cast(omega.array());
}

/// Where values (n, width) and their derivatives (n, width, m) go.
struct Field {
  Output value, slope;
  size_t width, m;

  Field(size_t n, size_t width_, size_t m_) : value({n, width_}), slope({n, width_, m_}), width(width_), m(m_) {}

  void put(size_t row, size_t column, const Seed& x, size_t first, int count) {
    value.data()[row * width + column] = x.v;
    for (int k = 0; k < count; ++k) slope.data()[(row * width + column) * m + first + k] = x.d[k];
  }
  nb::tuple arrays() { return nb::make_tuple(value.array(), slope.array()); }
};

/// Values and derivatives along m directions at n poses, of what `what` asks for (bits: 1 frequencies, 2 H, 4 legs, 8
/// stiffness).
///     "omega" (n, 6) and "rayleigh" (n, 6, 6, m); "H" and "stiffness" (n, 36); "leg_length" (n, 6), "leg_distance" (n, 15 pairs) and
///     "joint_cosine" (n, 12: universal, spherical), each as (value, derivative along the directions).
/// directions: (m, 211). displacements: (n, m, 6), of the poses along each direction. home: one motion, or empty, and
/// its displacements (m, 6).
nb::dict design_gradients(const Input& design, Joint joint, const Input& platforms, const Input& directions,
                          const Input& displacements, const Input& home, const Input& home_displacements,
                          unsigned what) {
  const Machine<double> machine = machine_of(design, joint);
  const size_t n = platforms.size() / motion_size, m = directions.size() / design_size;
  const Motion<double>* platform = motions(platforms, n, "platform");
  const double* along = rows(directions, m, design_size, "directions");
  const double* moves = rows(displacements, n * m, 6, "displacements");
  const Motion<double>* home_pose = home.size() == 0 ? nullptr : motions(home, 1, "home");
  const double* home_moves = home_pose == nullptr ? nullptr : rows(home_displacements, m, 6, "home_displacements");
  const bool frequencies = what & 1, forces = what & 2, legs = what & 4, stiffness = what & 8;

  Output omega({n, 6}), rayleigh({n, 6, 6, m});
  Field H(n, 36, m), K(n, 36, m), length(n, 6, m), distance(n, 15, m), cosine(n, 12, m);
  std::vector<Modes> modes(frequencies ? n : 0);
  double* w = omega.data();
  for (size_t i = 0; i < modes.size(); ++i) {
    const Geometry<double> g(machine.design, platform[i].pose, Pose<double>());
    modes[i] = natural_modes(machine, g, platform[i].pose.R);
    write(w, modes[i].omega);
  }
  for (size_t first = 0; first < m; first += gradient_lanes) {
    const int count = static_cast<int>(std::min<size_t>(gradient_lanes, m - first));
    const SeededDesign seeded(machine.design, along + first * design_size, count);
    const Machine<Seed> moved(seeded.design, machine.joint);
    Pose<Seed> home_moved;
    if (home_pose != nullptr) home_moved = seeded.pose(home_pose->pose, home_moves + first * 6);
    for (size_t i = 0; i < n; ++i) {
      const Pose<Seed> pose = seeded.pose(platform[i].pose, moves + (i * m + first) * 6);
      const Geometry<Seed> g(seeded.design, pose, Pose<Seed>());
      if (frequencies) {
        Seed products[6][6];
        rayleigh_matrix(moved, g, pose.R, modes[i], products);
        for (size_t a = 0; a < 6; ++a)
          for (size_t b = 0; b < 6; ++b)
            for (int k = 0; k < count; ++k)
              rayleigh.data()[((i * 6 + a) * 6 + b) * m + first + k] = products[a][b].d[k];
      }
      if (forces) {
        const Mat6<Seed> h = force_transformation(g);
        for (size_t a = 0; a < 36; ++a) H.put(i, a, h[a / 6][a % 6], first, count);
      }
      if (stiffness) {
        const Mat6<Seed> k = stiffness_matrix(moved.design, spring_directions(g));
        for (size_t a = 0; a < 36; ++a) K.put(i, a, k[a / 6][a % 6], first, count);
      }
      if (legs) {
        for (size_t a = 0; a < 6; ++a) length.put(i, a, norm(g.S[a]), first, count);
        size_t pair = 0;
        for (size_t a = 0; a < 5; ++a)
          for (size_t b = a + 1; b < 6; ++b)
            distance.put(i, pair++, segment_distance(g.q_b[a], g.S[a], g.q_b[b], g.S[b]), first, count);
        Seed angles[2][6];
        joint_cosines(seeded, pose, home_pose == nullptr ? nullptr : &home_moved, angles);
        for (size_t a = 0; a < 12; ++a) cosine.put(i, a, angles[a / 6][a % 6], first, count);
      }
    }
  }
  nb::dict result;
  if (frequencies) result["omega"] = omega.array(), result["rayleigh"] = rayleigh.array();
  if (forces) result["H"] = H.arrays();
  if (stiffness) result["stiffness"] = K.arrays();
  if (legs) {
    result["leg_length"] = length.arrays();
    result["leg_distance"] = distance.arrays();
    result["joint_cosine"] = cosine.arrays();
  }
  return result;
}

}  // namespace

void bind_designs(nb::module_& m) {
  m.def("sweep_designs", &sweep_designs);
  m.def("design_gradients", &design_gradients);
}

}  // namespace flexapod
