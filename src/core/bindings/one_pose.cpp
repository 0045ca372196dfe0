// One call for one pose: what a control loop or an optimiser of the user's own pays. Results are None where something is
// unusual: a batch, numbers that cannot be read at once, a pose that no leg can take, a singular one. Python then takes
// the way that many poses take, which tells what is wrong.
#include "bindings/arrays.hpp"
#include "bindings/bind.hpp"
#include "bindings/reading.hpp"
#include "kernels/isa.hpp"
#include "model/modes.hpp"
#include "model/statics.hpp"

namespace flexapod {
namespace {

/// What Python gives of a state: position and rotation, or six numbers and None; four rates of a motion, or None.
struct GivenState {
  nb::handle position, rotation, rates;

  explicit GivenState(const nb::tuple& given)
      : position(nb::handle(given[0])), rotation(nb::handle(given[1])), rates(nb::handle(given[2])) {}
};

Pose<double> pose_of(const double (&six)[6]) {
  return {{six[0], six[1], six[2]},
          roll_pitch_yaw<double>({std::sin(six[3]), std::sin(six[4]), std::sin(six[5])},
                                 {std::cos(six[3]), std::cos(six[4]), std::cos(six[5])})};
}

struct State {
  Motion<double> platform{}, base{};
};
one_pose_task::State numbers(const State& s) { return {&s.platform.pose.t.x, &s.base.pose.t.x}; }

nb::object three(const double* x) {
  return new_array({3}, [&](double* to) { std::copy_n(x, 3, to); });
}
nb::object six(const double* x) {
  return new_array({6}, [&](double* to) { std::copy_n(x, 6, to); });
}
template <int m> nb::object matrix(const Mat6<double, m>& x) {
  return new_array({6, m}, [&](double* to) { std::copy_n(&x.a[0][0], 6 * m, to); });
}

/// A machine with that of the kernel in use.
struct ReadyMachine {
  const one_pose_task::Kernel& kernel = kernels().one_pose;
  Machine<double> machine;
  void* own;  // the kernel's

  ReadyMachine(const Input& design, Joint joint)
      : machine(machine_of(design, joint)), own(kernel.new_machine(design.data(), joint)) {}
  ReadyMachine(const ReadyMachine&) = delete;
  ReadyMachine& operator=(const ReadyMachine&) = delete;
  ~ReadyMachine() { kernel.delete_machine(own); }

  Geometry<double> geometry(const State& s) const { return {machine.design, s.platform.pose, s.base.pose}; }
  /// Force, length, unstretched length, axial stiffness and stiffness against a command of leg i at rest.
  void rest_of_leg(int i, double force, double length, double (&legs)[5][6]) const {
    using D = Dual<1>;
    const double unstretched = unstretched_length(machine, i, length, force);
    const D stiffness = machine.stiffness(i, D::variable(unstretched, 0));
    legs[0][i] = force, legs[1][i] = length, legs[2][i] = unstretched, legs[3][i] = stiffness.v;
    legs[4][i] = stiffness.v + stiffness.d[0] * (unstretched - length);
  }
};

/// What the public functions ask: results are None where something is unusual, a batch, numbers that cannot be read at
/// once, a pose that no leg can take, a singular one. Python then takes the way of many poses, which tells what is wrong.
class OnePose {
 public:
  OnePose(const Input& design, Joint joint) : of_(design, joint), shortest_(shortest_leg(of_.machine.design)) {}

  nb::object leg_lengths(const nb::tuple& platform, const nb::tuple& base) const {
    State s;
    if (!read(platform, base, s)) return nb::none();
    const LegFit fit(of_.geometry(s));
    return usual(fit) ? six(fit.length) : nb::none();
  }

  nb::object natural_modes(const nb::tuple& platform, const nb::tuple& base) const {
    State s;
    if (!read(platform, base, s)) return nb::none();
    const Geometry<double> g = of_.geometry(s);
    if (!usual(LegFit(g))) return nb::none();
    const Modes modes = flexapod::natural_modes(of_.machine, g, s.platform.pose.R, s.base.pose.R);
    if (!finite(modes.omega, 6)) return nb::none();
    return nb::make_tuple(six(modes.omega), matrix(modes.shape));
  }

  nb::object forward_dynamics(const nb::tuple& platform, const nb::tuple& base, nb::handle leg_force, nb::handle force,
                              nb::handle moment) const {
    State s;
    double legs[6], wrench[6], found[6];
    if (!read(platform, base, s) || !read_finite(leg_force, legs, 6) || !read_wrench(force, moment, wrench) ||
        !usual(LegFit(of_.geometry(s))))
      return nb::none();
    of_.kernel.accelerations(of_.own, numbers(s), legs, wrench, found);
    if (!finite(found, 6)) return nb::none();
    return nb::make_tuple(three(found), three(found + 3));
  }

  nb::object inverse_dynamics(const nb::tuple& platform, const nb::tuple& base, nb::handle force,
                              nb::handle moment) const {
    State s;
    double wrench[6];
    if (!read(platform, base, s) || !read_wrench(force, moment, wrench)) return nb::none();
    const Geometry<double> g = of_.geometry(s);
    if (!usual(LegFit(g))) return nb::none();
    const Vec6<double> found = leg_forces(g, s, wrench);
    return finite(found.a, 6) ? six(found.a) : nb::none();
  }

  /// M, C, K, M_b, C_b, K_b, H and the carrying of the platform by the base (8, 6, 6); leg forces, leg lengths, unstretched
  /// lengths, axial stiffnesses and stiffnesses against commands (5, 6); F, (6, springs); the pose's numbers (12,).
  nb::object linearise(const nb::tuple& platform, const nb::tuple& base, nb::handle force, nb::handle moment) const {
    State s;
    double wrench[6], legs[5][6], matrices[8][36];
    if (!read(platform, base, s) || !read_wrench(force, moment, wrench)) return nb::none();
    const Geometry<double> g = of_.geometry(s);
    const LegFit fit(g);
    if (!usual(fit)) return nb::none();
    const Vec6<double> needed = leg_forces(g, s, wrench);
    for (int i = 0; i < 6; ++i) of_.rest_of_leg(i, needed[i], fit.length[i], legs);
    if (!finite(legs[0], 30)) return nb::none();
    auto& [M, C, K, M_b, C_b, K_b, H, carry] = matrices;
    of_.kernel.tangent(of_.own, numbers(s), wrench, legs[0], legs[3], {M, C, K, H, M_b, C_b, K_b});
    if (!finite(matrices[0], 7 * 36)) return nb::none();
    set_carry(s.platform.pose.t - s.base.pose.t, carry);
    const auto copy = [](const void* from, size_t size) { return [=](double* to) { std::memcpy(to, from, size); }; };
    return nb::make_tuple(new_array({8, 6, 6}, copy(matrices, sizeof(matrices))),
                          new_array({5, 6}, copy(legs, sizeof(legs))), springs(g, s),
                          new_array({pose_size}, copy(&s.platform.pose, sizeof(s.platform.pose))));
  }

 private:
  static bool read(const GivenState& given, Motion<double>& to) {
    if (given.rotation.is_none()) {
      double six[6];
      if (!read_finite(given.position, six, 6)) return false;
      to.pose = pose_of(six);
    } else {
      const ArrayView rotation(given.rotation.ptr());
      if (!read_finite(given.position, &to.pose.t.x, 3) || !rotation.has_shape({3, 3})) return false;
      rotation.copy_to(&to.pose.R.row[0].x);
      if (!finite(&to.pose.R.row[0].x, 9)) return false;
    }
    if (given.rates.is_none()) return true;
    PyObject* four = given.rates.ptr();
    if (!PyTuple_CheckExact(four) || PyTuple_GET_SIZE(four) != 4) return false;
    for (int i = 0; i < 4; ++i)
      if (!read_finite(PyTuple_GET_ITEM(four, i), &to.v.x + 3 * i, 3)) return false;
    return true;
  }
  /// A base that is not given is at the origin, at rest.
  static bool read(const nb::tuple& platform, const nb::tuple& base, State& s) {
    return read(GivenState(platform), s.platform) && (nb::handle(base[0]).is_none() || read(GivenState(base), s.base));
  }
  /// To the last bit those of many poses; NaN where H is singular.
  Vec6<double> leg_forces(const Geometry<double>& g, const State& s, const double (&wrench)[6]) const {
    const Vec6<double> load = external_wrench(s.platform.pose.R, *reinterpret_cast<const Vec6<double>*>(wrench));
    return flexapod::inverse_dynamics(of_.machine, g, s.platform, s.base, load);
  }
  static bool read_wrench(nb::handle force, nb::handle moment, double (&to)[6]) {
    return read_finite(force, to, 3) && read_finite(moment, to + 3, 3);
  }
  /// Whether every leg has a length and a stiffness and can turn.
  bool usual(const LegFit& fit) const {
    bool good = true;
    for (int i = 0; i < 6; ++i) good = good && fit.length[i] >= shortest_ && fit.sine[i] >= least_sine;
    return good;
  }
  /// How the platform moves that is carried by the base: by x_b, and by its turn about the base's reference point.
  static void set_carry(const Vec3<double>& r, double (&to)[36]) {
    std::fill_n(to, 36, 0.0);
    for (int i = 0; i < 6; ++i) to[7 * i] = 1.0;
    to[0 + 4] = r.z, to[0 + 5] = -r.y, to[6 + 3] = -r.z, to[6 + 5] = r.x, to[12 + 3] = r.y, to[12 + 4] = -r.x;
  }
  nb::object springs(const Geometry<double>& g, const State& s) const {
    if (!of_.machine.features.others()) return matrix(leg_spring_matrix(of_.machine, g));
    return matrix(spring_matrix(of_.machine, g, s.platform.pose.R, s.base.pose.R));
  }

  const ReadyMachine of_;
  const double shortest_;
};

/// What a compiled machine is asked: arrays whose shapes are checked and nothing else. None where one is wrong.
class Compiled {
 public:
  Compiled(const Input& design, Joint joint, const Input& base)
      : of_(design, joint), base_(*reinterpret_cast<const Pose<double>*>(rows(base, 1, pose_size, "base"))) {}

  nb::object stability_index(nb::handle pose) const {
    State s = start();
    double omega;
    if (!read(pose, s)) return nb::none();
    of_.kernel.frequencies(of_.own, numbers(s), 1, &omega);
    return nb::float_(omega);
  }
  nb::object natural_frequencies(nb::handle pose) const {
    State s = start();
    if (!read(pose, s)) return nb::none();
    return new_array({6}, [&](double* to) { of_.kernel.frequencies(of_.own, numbers(s), 6, to); });
  }
  nb::object leg_lengths(nb::handle pose) const {
    State s = start();
    if (!read(pose, s)) return nb::none();
    const Geometry<double> g = of_.geometry(s);
    return new_array({6}, [&](double* to) {
      for (const Vec3<double>& S : g.S) *to++ = norm(S);
    });
  }
  nb::object jacobian(nb::handle pose) const {
    State s = start();
    if (!read(pose, s)) return nb::none();
    const Mat6<double> H = force_transformation(of_.geometry(s));
    return new_array({6, 6}, [&](double* to) {
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) *to++ = H[j][i];
    });
  }
  nb::object forward_dynamics(nb::handle pose, nb::handle twist, nb::handle leg_force, nb::handle wrench) const {
    State s = start();
    double legs[6], load[6] = {};
    if (!read(pose, s) || !read_six(twist, &s.platform.v.x) || !read_six(leg_force, legs) || !read_six(wrench, load))
      return nb::none();
    return new_array({6}, [&](double* to) { of_.kernel.accelerations(of_.own, numbers(s), legs, load, to); });
  }
  nb::object inverse_dynamics(nb::handle pose, nb::handle twist, nb::handle acceleration, nb::handle wrench) const {
    State s = start();
    double load[6] = {};
    if (!read(pose, s) || !read_six(twist, &s.platform.v.x) || !read_six(acceleration, &s.platform.a.x) ||
        !read_six(wrench, load))
      return nb::none();
    return new_array({6}, [&](double* to) { of_.kernel.leg_forces(of_.own, numbers(s), load, to); });
  }
  /// M, C, K and H, (6, 6) each.
  nb::object linearised(nb::handle pose, nb::handle wrench) const {
    State s = start();
    double load[6] = {}, *to[4];
    if (!read(pose, s) || !read_six(wrench, load)) return nb::none();
    const auto matrix = [&](int i) { return new_array({6, 6}, [&](double* numbers) { to[i] = numbers; }); };
    nb::object M = matrix(0), C = matrix(1), K = matrix(2), H = matrix(3);
    of_.kernel.linearised(of_.own, numbers(s), load, {to[0], to[1], to[2], to[3], nullptr, nullptr, nullptr});
    return nb::make_tuple(std::move(M), std::move(C), std::move(K), std::move(H));
  }

 private:
  State start() const {
    State s;
    s.base.pose = base_;
    return s;
  }
  /// x, y, z, roll, pitch, yaw, or a position and a matrix by rows.
  static bool read(nb::handle pose, State& s) {
    double given[6];
    if (read_numbers(pose, given, 6)) {
      s.platform.pose = pose_of(given);
      return true;
    }
    return read_numbers(pose, &s.platform.pose.t.x, pose_size);
  }
  static bool read_six(nb::handle x, double* to) { return read_numbers(x, to, 6); }

  const ReadyMachine of_;
  const Pose<double> base_;
};

}  // namespace

// What Python is told of the arguments and results; a state is position and rotation, or six numbers and None, and rates.
#define FLEXAPOD_STATES "platform: tuple[object, ...], base: tuple[object, ...]"

void bind_one_pose(nb::module_& m) {
  ArrayInterface::get();              // now, under Python's import lock: later, two threads could wait for each other
  const auto any = nb::arg().none();  // what is no array is answered with None
  nb::class_<OnePose>(m, "OnePose")
      .def(nb::init<const Input&, Joint>())
      .def("leg_lengths", &OnePose::leg_lengths,
           nb::sig("def leg_lengths(self, " FLEXAPOD_STATES ", /) -> ndarray | None"))
      .def("natural_modes", &OnePose::natural_modes,
           nb::sig("def natural_modes(self, " FLEXAPOD_STATES ", /) -> tuple[ndarray, ndarray] | None"))
      .def("forward_dynamics", &OnePose::forward_dynamics, nb::arg(), nb::arg(), any, any, any,
           nb::sig("def forward_dynamics(self, " FLEXAPOD_STATES
                   ", leg_force: object, force: object, moment: object, /) -> "
                   "tuple[ndarray, ndarray] | None"))
      .def("inverse_dynamics", &OnePose::inverse_dynamics, nb::arg(), nb::arg(), any, any,
           nb::sig("def inverse_dynamics(self, " FLEXAPOD_STATES
                   ", force: object, moment: object, /) -> ndarray | None"))
      .def("linearise", &OnePose::linearise, nb::arg(), nb::arg(), any, any,
           nb::sig("def linearise(self, " FLEXAPOD_STATES ", force: object, moment: object, /) -> "
                   "tuple[ndarray, ndarray, ndarray, ndarray] | None"));
  nb::class_<Compiled>(m, "Compiled")
      .def(nb::init<const Input&, Joint, const Input&>())
      .def("stability_index", &Compiled::stability_index, any,
           nb::sig("def stability_index(self, pose: object, /) -> float | None"))
      .def("natural_frequencies", &Compiled::natural_frequencies, any,
           nb::sig("def natural_frequencies(self, pose: object, /) -> ndarray | None"))
      .def("leg_lengths", &Compiled::leg_lengths, any,
           nb::sig("def leg_lengths(self, pose: object, /) -> ndarray | None"))
      .def("jacobian", &Compiled::jacobian, any, nb::sig("def jacobian(self, pose: object, /) -> ndarray | None"))
      .def("forward_dynamics", &Compiled::forward_dynamics, any, any, any, any,
           nb::sig("def forward_dynamics(self, pose: object, twist: object, leg_force: object, wrench: object, /) -> "
                   "ndarray | None"))
      .def(
          "inverse_dynamics", &Compiled::inverse_dynamics, any, any, any, any,
          nb::sig("def inverse_dynamics(self, pose: object, twist: object, acceleration: object, wrench: object, /) -> "
                  "ndarray | None"))
      .def("linearised", &Compiled::linearised, any, any,
           nb::sig("def linearised(self, pose: object, wrench: object, /) -> "
                   "tuple[ndarray, ndarray, ndarray, ndarray] | None"));
  m.attr("least_sine") = least_sine;
  m.def("shortest_leg", [](const Input& design) { return shortest_leg(machine_of(design).design); });
}
#undef FLEXAPOD_STATES

}  // namespace flexapod
