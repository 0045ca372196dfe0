// Simulations as Python sees them: many at once on all threads, stopped by an interrupt.
#include "bindings/simulation.hpp"

#include <nanobind/stl/vector.h>

#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "bindings/arrays.hpp"
#include "bindings/sweep.hpp"
#include "simulation/excitation.hpp"

#if defined(FLEXAPOD_X86)
namespace flexapod_avx512 {
extern const simulation_task::Kernel simulation_kernel;
}
namespace flexapod_avx2 {
extern const simulation_task::Kernel simulation_kernel;
}
#endif
namespace flexapod_baseline {
extern const simulation_task::Kernel simulation_kernel;
}

namespace flexapod {
namespace {

using simulation_task::Kernel;
using simulation_task::setup_size;

constexpr const Kernel* kernels[] = {
#if defined(FLEXAPOD_X86)
    &flexapod_avx512::simulation_kernel, &flexapod_avx2::simulation_kernel,
#endif
    &flexapod_baseline::simulation_kernel};

/// That for the instruction set which the sweeps use.
const Kernel* chosen = nullptr;

/// Runs job(i) for i < n on threads, while this one asks Python for interrupts and reports progress.
class Crew {
 public:
  std::atomic<bool> stop{false};

  template <class Job>
  void run(size_t n, size_t threads, nb::object report, const std::vector<std::atomic<double>>& done, Job&& job) {
    std::atomic<size_t> next{0}, running{std::min(n, threads)};
    std::vector<std::thread> workers;
    for (size_t w = std::min(n, threads); w > 0; --w)
      workers.emplace_back([&] {
        for (size_t i; !stop && (i = next++) < n;) job(i);
        const std::lock_guard lock(mutex_);
        if (--running == 0) finished_.notify_all();
      });
    try {
      wait(running, report, done);
    } catch (...) {
      stop = true;
      join(workers);
      throw;
    }
    join(workers);
  }

 private:
  void wait(const std::atomic<size_t>& running, const nb::object& report,
            const std::vector<std::atomic<double>>& done) {
    while (running > 0) {
      {
        const nb::gil_scoped_release free;
        std::unique_lock lock(mutex_);
        finished_.wait_for(lock, std::chrono::milliseconds(50), [&] { return running == 0; });
      }
      if (PyErr_CheckSignals() != 0) throw nb::python_error();
      if (report.is_none()) continue;
      double sum = 0;
      for (const auto& part : done) sum += part;
      report(sum / static_cast<double>(done.size()));
    }
  }
  static void join(std::vector<std::thread>& workers) {
    const nb::gil_scoped_release free;
    for (std::thread& worker : workers) worker.join();
  }

  std::mutex mutex_;
  std::condition_variable finished_;
};

/// A machine for the kernel, with the excitations of its base, wrench and leg command.
simulation_task::Machine machine(const double* design, Joint joint, const double* setup, bool works, const Input& base,
                                 const Input& wrench, const Input& command) {
  const auto series = [](const Input& e) {
    static_cast<void>(Excitation(e.data(), e.size()));  // throws here, not on a thread, if the numbers are wrong
    return simulation_task::Series{e.data(), e.size()};
  };
  return {design, joint, setup, works, series(base), series(wrench), series(command)};
}

Output nan_filled(std::initializer_list<size_t> shape) {
  Output out(shape);
  size_t size = 1;
  for (const size_t n : shape) size *= n;
  std::fill_n(out.data(), size, std::numeric_limits<double>::quiet_NaN());
  return out;
}

/// `excitations`: for each simulation those of base, wrench and leg command. `options`: rtol, atol, max_step, max_steps,
/// stop_at_singular, motions, works, threads.
nb::tuple simulate(const Input& designs, Joint joint, const Input& setups, const std::vector<Input>& excitations,
                   const Input& times, const Input& options, nb::object progress) {
  const size_t n = setups.size() / setup_size;
  const double* design = rows(designs, n, design_size, "designs");
  const double* setup = rows(setups, n, setup_size, "setups");
  const double* o = rows(options, 1, 8, "options");
  if (excitations.size() != 3 * n || n == 0 || times.size() % n != 0)
    throw std::invalid_argument("excitations or times do not fit the number of simulations");
  const size_t m = times.size() / n, kept = o[5] != 0.0 ? m : 0;
  const simulation_task::Tolerances tolerances{o[0], o[1], o[2], o[3], o[4] != 0.0};
  const bool works = o[6] != 0.0;

  std::vector<simulation_task::Machine> driven;
  for (size_t i = 0; i < n; ++i)
    driven.push_back(machine(design + i * design_size, joint, setup + i * setup_size, works, excitations[3 * i],
                             excitations[3 * i + 1], excitations[3 * i + 2]));
  Output displacement = nan_filled({n, m, 6}), relative = nan_filled({n, m, 6}), work = nan_filled({n, m, 4}),
         platform = nan_filled({n, kept, 24}), base = nan_filled({n, kept, 24}), leg_force = nan_filled({n, kept, 6}),
         outcome({n}), time({n}), last({n, 24}), counts({n, 3});
  double *x = displacement.data(), *u = relative.data(), *p = platform.data(), *b = base.data(), *W = work.data(),
         *F = leg_force.data(), *how = outcome.data();
  double *ended = time.data(), *c = counts.data();
  double* final_motion = last.data();
  std::vector<std::atomic<double>> done(n);
  Crew crew;
  crew.run(n, static_cast<size_t>(o[7]), progress, done, [&](size_t i) {
    const auto part = [&](double* rows, size_t width) { return kept ? rows + i * m * width : nullptr; };
    const simulation_task::Samples samples{times.data() + i * m, m,           x + i * m * 6, u + i * m * 6,
                                           W + i * m * 4,        part(p, 24), part(b, 24),   part(F, 6)};
    const simulation_task::End end = chosen->simulate({driven[i], tolerances, samples, &crew.stop, &done[i]});
    done[i] = 1.0;
    how[i] = static_cast<double>(end.outcome), ended[i] = end.time;
    std::copy_n(end.last, motion_size, final_motion + i * motion_size);
    c[3 * i] = end.accepted, c[3 * i + 1] = end.rejected, c[3 * i + 2] = end.evaluations;
  });
  return nb::make_tuple(displacement.array(), relative.array(), work.array(), platform.array(), base.array(),
                        leg_force.array(), outcome.array(), time.array(), last.array(), counts.array());
}

/// One run of a sampled controller. `controller`: A, B, C, D, limit (see SampledController); `noise`: 36 for each sample;
/// `timing`: dt, steps of a sample. Returns rows at every step's end, from t = 0, of measurements and displacement (NaN
/// after an early end), forces and clipping at every sample, and the outcome.
nb::tuple control_loop(const Input& design, Joint joint, const Input& setup, const Input& base,
                       const std::vector<Input>& controller, const Input& noise, const Input& timing,
                       nb::object progress) {
  constexpr size_t signals = simulation_task::signals;
  if (controller.size() != 5) throw std::invalid_argument("a controller is A, B, C, D and limit");
  const size_t order = controller[2].size() / 6, samples = noise.size() / signals;
  const simulation_task::Controller law{order,
                                        rows(controller[0], order, order, "A"),
                                        rows(controller[1], order, signals, "B"),
                                        rows(controller[2], 6, order, "C"),
                                        rows(controller[3], 6, signals, "D"),
                                        rows(controller[4], 1, 6, "limit")};
  const double* when = rows(timing, 1, 2, "timing");
  const simulation_task::Timing clock{when[0], samples, static_cast<size_t>(when[1])};
  const size_t m = samples * clock.steps + 1;
  const double* white = rows(noise, samples, signals, "noise");
  const Input none{};
  const simulation_task::Machine shaken = machine(rows(design, 1, design_size, "design"), joint,
                                                  rows(setup, 1, setup_size, "setup"), false, base, none, none);
  Output measured = nan_filled({m, signals}), displacement = nan_filled({m, 6}), force = nan_filled({samples, 6});
  Output cut({samples}), outcome({1});
  const simulation_task::Record record{measured.data(), displacement.data(), force.data(), cut.data()};
  double* how = outcome.data();
  std::vector<std::atomic<double>> done(1);
  Crew crew;
  crew.run(1, 1, progress, done, [&](size_t) {
    *how = static_cast<double>(chosen->control_loop({shaken, law, clock, white, record, &crew.stop, &done[0]}));
  });
  return nb::make_tuple(measured.array(), displacement.array(), force.array(), cut.array(), outcome.array());
}
/// The equations of one simulation for other integrators: y' = rates(t, y) from y = start().
class Equations {
 public:
  Equations(const Input& design, Joint joint, const Input& setup, const std::vector<Input>& excitations) {
    for (const Input& e : excitations) numbers_.emplace_back(e.data(), e.data() + e.size());
    const auto part = [&](size_t i) { return simulation_task::Series{numbers_.at(i).data(), numbers_.at(i).size()}; };
    equations_ = chosen->new_equations({rows(design, 1, design_size, "design"), joint,
                                        rows(setup, 1, setup_size, "setup"), false, part(0), part(1), part(2)});
  }
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;
  ~Equations() { chosen->delete_equations(equations_); }

  nb::object start() {
    Output y({size});
    chosen->start(equations_, y.data());
    return nb::cast(y.array());
  }
  nb::object rates(double t, const Input& y) {
    Output rate({size});
    chosen->rates(equations_, t, rows(y, 1, size, "y"), rate.data());
    return nb::cast(rate.array());
  }

 private:
  static constexpr size_t size = 12;
  std::vector<std::vector<double>> numbers_;  // what the excitations point to
  void* equations_;
};

/// Six channels with their first and second derivatives, (n, 3, 6).
nb::object excitation(const Input& terms, const Input& times) {
  Excitation e(terms.data(), terms.size());
  const size_t n = times.size();
  Output values({n, 3, 6});
  double* out = values.data();
  for (size_t i = 0; i < n; ++i) {
    Jet channel[6];
    e.at(times.data()[i], times.data()[i], channel);
    for (const auto part : {&Jet::x, &Jet::v, &Jet::a})
      for (const Jet& jet : channel) *out++ = jet.*part;
  }
  return nb::cast(values.array());
}

/// Rows of 24 numbers: how the base moves from its pose at rest.
nb::object base_motion(const Input& terms, bool roll_pitch_yaw, const Input& rest, const Input& times) {
  Excitation e(terms.data(), terms.size());
  const Motion<double>* pose = motions(rest, 1, "rest");
  const size_t n = times.size();
  Output out({n, 24});
  auto* motion = reinterpret_cast<Motion<double>*>(out.data());
  for (size_t i = 0; i < n; ++i) {
    Jet channel[6];
    e.at(times.data()[i], times.data()[i], channel);
    motion[i] = BaseMotion(pose->pose, channel, e.uses(3, 6), roll_pitch_yaw).motion;
  }
  return nb::cast(out.array());
}

}  // namespace

const Kernel& simulation_kernel_in_use() { return *chosen; }

void bind_simulation(nb::module_& m) {
  chosen = *std::find_if(std::begin(kernels), std::end(kernels),
                         [](const Kernel* k) { return std::strcmp(k->name, kernel_in_use().name) == 0; });
  m.attr("setup_size") = setup_size;
  m.def("simulate", &simulate, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg().none());
  m.def("control_loop", &control_loop, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(),
        nb::arg().none());
  nb::class_<Equations>(m, "Equations")
      .def(nb::init<const Input&, Joint, const Input&, const std::vector<Input>&>())
      .def("start", &Equations::start)
      .def("rates", &Equations::rates);
  m.def("excitation", &excitation);
  m.def("base_motion", &base_motion);
}

}  // namespace flexapod
