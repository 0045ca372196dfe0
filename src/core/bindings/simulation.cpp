// Simulations as Python sees them: many at once on threads, stopped by an interrupt.
#include <nanobind/stl/vector.h>

#include "bindings/arrays.hpp"
#include "bindings/attend.hpp"
#include "bindings/bind.hpp"
#include "kernels/isa.hpp"
#include "simulation/control_batch.hpp"

namespace flexapod {
namespace {

using simulation_task::Options;

Numbers numbers(const Input& input) { return {input.data(), input.data() + input.size()}; }

SimulationResult simulate(const std::vector<const SimulationSetup*>& setups, const Input& times, const Options& options,
                          const nb::object& progress) {
  if (setups.empty() || times.size() % setups.size() != 0 || options.threads < 1)
    throw std::invalid_argument("times do not fit the number of simulations, or threads is not >= 1");
  SimulationBatch batch(kernels().simulation, setups, span(times), options);
  {
    Crew crew(setups.size(), options.threads, [&](size_t i) { batch.run(i, crew.stop); });
    attend(crew, [&] { return batch.done(); }, progress);
  }
  return std::move(batch.result);
}

ControlRecord control_loop(const SimulationSetup& setup, const ControllerMatrices& controller, const Input& noise,
                           double dt, size_t steps, const nb::object& progress) {
  const size_t samples = noise.size() / simulation_task::signals;
  rows(noise, samples, simulation_task::signals, "noise");
  ControlRun run(kernels().simulation, setup, controller, span(noise), dt, steps);
  {
    Crew crew(1, 1, [&](size_t) { run.run(crew.stop); });
    attend(crew, [&] { return run.done(); }, progress);
  }
  return std::move(run.record);
}

void bind_options(nb::module_& m) {
  nb::class_<Options>(m, "SimulationOptions")
      .def(
          "__init__",
          [](Options* self, double rtol, double atol, double max_step, double max_steps, bool stop_at_singular,
             bool motions, bool works, bool exponential, int threads) {
            new (self) Options{rtol, atol, max_step, max_steps, stop_at_singular, motions, works, exponential, threads};
          },
          nb::kw_only(), "rtol"_a, "atol"_a, "max_step"_a, "max_steps"_a, "stop_at_singular"_a, "motions"_a, "works"_a,
          "exponential"_a, "threads"_a)
      .def_rw("rtol", &Options::rtol)
      .def_rw("atol", &Options::atol)
      .def_rw("max_step", &Options::max_step)
      .def_rw("max_steps", &Options::max_steps)
      .def_rw("stop_at_singular", &Options::stop_at_singular)
      .def_rw("motions", &Options::motions)
      .def_rw("works", &Options::works)
      .def_rw("exponential", &Options::exponential)
      .def_rw("threads", &Options::threads);
}

void make_setup(SimulationSetup* self, const Input& design, Joint joint, const Input& platform, const Input& base,
                const Input& leg_force, const Input& wrench, const Input& displacement, const Input& velocity,
                bool roll_pitch_yaw, bool carried, const Input& base_motion, const Input& load, const Input& command) {
  SimulationSetup setup{numbers(design),    joint,           numbers(platform),     numbers(base),
                        numbers(leg_force), numbers(wrench), numbers(displacement), numbers(velocity),
                        roll_pitch_yaw,     carried,         numbers(base_motion),  numbers(load),
                        numbers(command)};
  setup.check();
  new (self) SimulationSetup(std::move(setup));
}

void make_controller(ControllerMatrices* self, const Input& A, const Input& B, const Input& C, const Input& D,
                     const Input& limit) {
  ControllerMatrices controller{numbers(A), numbers(B), numbers(C), numbers(D), numbers(limit)};
  controller.check();
  new (self) ControllerMatrices(std::move(controller));
}

void bind_setups(nb::module_& m) {
  nb::class_<SimulationSetup>(m, "SimulationSetup")
      .def("__init__", &make_setup, nb::kw_only(), "design"_a, "joint"_a, "platform"_a, "base"_a, "leg_force"_a,
           "wrench"_a, "displacement"_a, "velocity"_a, "roll_pitch_yaw"_a, "carried"_a, "base_motion"_a, "load"_a,
           "command"_a)
      .def_ro("joint", &SimulationSetup::joint)
      .def_ro("roll_pitch_yaw", &SimulationSetup::roll_pitch_yaw)
      .def_ro("carried", &SimulationSetup::carried);
  nb::class_<ControllerMatrices>(m, "ControllerMatrices")
      .def("__init__", &make_controller, nb::kw_only(), "A"_a, "B"_a, "C"_a, "D"_a, "limit"_a)
      .def_prop_ro("order", &ControllerMatrices::order);
}

void bind_results(nb::module_& m) {
  nb::class_<SimulationResult> result(m, "SimulationResult");
  show(result, "displacement", &SimulationResult::displacement);
  show(result, "relative", &SimulationResult::relative);
  show(result, "work", &SimulationResult::work);
  show(result, "platform", &SimulationResult::platform);
  show(result, "base", &SimulationResult::base);
  show(result, "leg_force", &SimulationResult::leg_force);
  result.def_ro("outcome", &SimulationResult::outcome);
  show(result, "time", &SimulationResult::time);
  show(result, "last", &SimulationResult::last);
  show(result, "steps", &SimulationResult::steps);

  nb::class_<ControlRecord> record(m, "ControlRecord");
  show(record, "measured", &ControlRecord::measured);
  show(record, "displacement", &ControlRecord::displacement);
  show(record, "force", &ControlRecord::force);
  show(record, "cut", &ControlRecord::cut);
  record.def_ro("outcome", &ControlRecord::outcome);
}

}  // namespace

void bind_simulation(nb::module_& m) {
  bind_options(m);
  bind_setups(m);
  bind_results(m);
  m.def("simulate", &simulate, nb::arg(), nb::arg(), nb::arg(), nb::arg().none());
  m.def("control_loop", &control_loop, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg().none());
  nb::class_<Equations>(m, "Equations")
      .def("__init__",
           [](Equations* self, const SimulationSetup& setup) { new (self) Equations(kernels().simulation, setup); })
      .def("start", [](const Equations& self) { return numpy(self.start()); })
      .def("rates", [](const Equations& self, double t, const Input& y) {
        return numpy(self.rates(t, rows(y, 1, Equations::size, "y")));
      });
  m.def("excitation",
        [](const Input& terms, const Input& times) { return numpy(excitation_at(span(terms), span(times))); });
  m.def("base_motion", [](const Input& terms, bool roll_pitch_yaw, const Input& rest, const Input& times) {
    return numpy(base_motion_at(span(terms), roll_pitch_yaw, motions(rest, 1, "rest")->pose, span(times)));
  });
}

}  // namespace flexapod
