// The names and layouts that Python takes from the core.
#include "bindings/arrays.hpp"
#include "bindings/bind.hpp"
#include "kernels/isa.hpp"
#include "model/statics.hpp"
#include "simulation/excitation.hpp"

namespace flexapod {
namespace {

nb::tuple shape(const Field& f) {
  nb::list sizes;
  if (f.stride > 0) sizes.append(6);
  if (f.rows() > 1) sizes.append(f.rows());
  if (f.columns() > 1) sizes.append(f.columns());
  return nb::tuple(sizes);
}

/// Where each of the field's numbers is, in the field's shape.
nb::object index(const Field& f) {
  nb::list places;
  for (int leg = 0; leg < (f.stride > 0 ? 6 : 1); ++leg)
    for (int row = 0; row < f.rows(); ++row)
      for (int column = 0; column < f.columns(); ++column) places.append(f.at(leg, row, column));
  const nb::module_ numpy = nb::module_::import_("numpy");
  return numpy.attr("array")(places, numpy.attr("int64")).attr("reshape")(shape(f));
}

template <std::size_t n> nb::tuple rows_of(const std::array<Field, n>& fields) {
  nb::list rows;
  for (const Field& f : fields) rows.append(f);
  return nb::tuple(rows);
}

/// A piece of an excitation, as NumPy describes structures.
nb::list piece_type() {
  nb::list type;
  type.append(nb::make_tuple("start", "f8"));
  type.append(nb::make_tuple("coefficients", "f8", std::size(Piece().coefficients)));
  type.append(nb::make_tuple("sine", "f8"));
  type.append(nb::make_tuple("omega", "f8"));
  return type;
}

void bind_layouts(nb::module_& m) {
  nb::class_<Field>(m, "Field")
      .def_prop_ro("name", [](const Field& f) { return f.name; })
      .def_ro("offset", &Field::offset)
      .def_ro("stride", &Field::stride)
      .def_prop_ro("shape", &shape)
      .def_prop_ro("unit", [](const Field& f) { return f.unit; })
      .def_prop_ro("index", &index);
  m.attr("DESIGN_LAYOUT") = rows_of(design_layout);
  m.attr("MOTION_LAYOUT") = rows_of(motion_layout);
  m.attr("PIECE") = piece_type();
  m.attr("design_size") = design_size;
  m.attr("plain_size") = plain_size;
  m.attr("motion_size") = motion_size;
}

void bind_enums(nb::module_& m) {
  nb::enum_<Joint>(m, "Joint").value("universal", Joint::universal).value("spin_free", Joint::spin_free);
  nb::enum_<Law>(m, "Law")
      .value("constant", Law::constant)
      .value("screw", Law::screw)
      .value("hydraulic", Law::hydraulic)
      .value("table", Law::table);
  nb::enum_<Rest>(m, "Rest")
      .value("found", Rest::found)
      .value("singular", Rest::singular)
      .value("not_found", Rest::not_found);
  nb::enum_<TermKind>(m, "TermKind")
      .value("sinusoids", TermKind::sinusoids)
      .value("chirp", TermKind::chirp)
      .value("pieces", TermKind::pieces);

  using simulation_task::Measure, simulation_task::Outcome;
  nb::enum_<Measure>(m, "Measure")
      .value("leg_length", Measure::leg_length)
      .value("leg_rate", Measure::leg_rate)
      .value("leg_force", Measure::leg_force)
      .value("position", Measure::position)
      .value("velocity", Measure::velocity)
      .value("acceleration", Measure::acceleration);
  nb::enum_<Outcome>(m, "Outcome")
      .value("complete", Outcome::complete)
      .value("singular", Outcome::singular)
      .value("leg_collapsed", Outcome::leg_collapsed)
      .value("joint_locked", Outcome::joint_locked)
      .value("step_collapse", Outcome::step_collapse)
      .value("not_finite", Outcome::not_finite)
      .value("max_steps", Outcome::max_steps)
      .value("stopped", Outcome::stopped)
      .value("outside_stiffness_law", Outcome::outside_stiffness_law);

  using sweep_task::Quantity, sweep_task::Status;
  nb::enum_<Quantity> quantities(m, "SweepQuantity", nb::is_flag());
#define FLEXAPOD_VALUE(name) quantities.value(#name, Quantity::name);
  FLEXAPOD_SWEEP_QUANTITIES(FLEXAPOD_VALUE)
  nb::enum_<Status>(m, "SweepStatus")
      .value("ok", Status::ok)
      .value("singular", Status::singular)
      .value("no_leg", Status::no_leg)
      .value("not_finite", Status::not_finite)
      .value("no_inertia", Status::no_inertia)
      .value("outside_stiffness_law", Status::outside_stiffness_law);
}

nb::tuple simd_available() {
  nb::list names;
  for (const Kernels& k : all_kernels)
    if (k.runs_here()) names.append(k.name());
  return nb::tuple(names);
}

}  // namespace

void bind_types(nb::module_& m) {
  kernels();  // an instruction set that is not there is an error of the import
  bind_layouts(m);
  bind_enums(m);
  m.attr("compiler") = FLEXAPOD_COMPILER;
  m.def("simd", [] { return kernels().name(); });
  m.def("simd_available", &simd_available);
}

}  // namespace flexapod
