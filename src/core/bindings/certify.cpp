// Certificates as Python sees them.
#include <nanobind/stl/optional.h>

#include <optional>

#include "bindings/arrays.hpp"
#include "bindings/attend.hpp"
#include "bindings/bind.hpp"
#include "certify/batch.hpp"
#include "kernels/isa.hpp"

namespace flexapod {
namespace {

using certify_task::BrokenLimit, certify_task::Kind, certify_task::Task;
using sweep_task::Limits;

struct Options : CertifyOptions {
  std::optional<Limits> limits;
  std::vector<double> strays{};  // rows of the numbers that may
  std::array<double, 4> payload{};
  std::vector<double> home{};  // none, or of a pose

  void set_strays(const Input& given, const Input& load, const Input& middle) {
    if (given.size() % stray_numbers != 0) throw std::invalid_argument("strays must have shape (n, stray_numbers)");
    strays.assign(given.data(), given.data() + given.size());
    std::copy_n(rows(load, 1, 4, "payload"), 4, payload.begin());
    if (middle.size() > 0) home.assign(rows(middle, 1, 12, "home"), middle.data() + 12);
  }
};

Task task_of(const Input& design, Joint joint, Kind kind) {
  Task task{};
  task.design = rows(design, 1, design_size, "design"), task.joint = joint, task.kind = kind;
  return task;
}

Certification run(Task task, double level, const Options& options, std::vector<certify_task::Box> boxes,
                  const nb::object& progress) {
  task.limits = options.limits ? &*options.limits : nullptr;
  task.reach = options.strays.data(), task.strays = static_cast<int>(options.strays.size() / stray_numbers);
  std::ranges::copy(options.payload, task.payload);
  task.home = options.home.empty() ? nullptr : options.home.data();
  check_strays(task);
  if (task.kind == Kind::limits && task.limits == nullptr) throw std::invalid_argument("limits are not given");
  CertifySearch search(kernels().certify, task, level, options, std::move(boxes));
  {
    Crew crew(options.threads, options.threads, [&](size_t) { search.run(crew.stop); });
    attend(crew, [&] { return search.done(); }, progress);
  }
  return Certification(search, task.pieces != nullptr);
}

Certification certify(const Input& design, Joint joint, const Input& boxes, Kind kind, double level,
                      const Options& options, const nb::object& progress) {
  return run(task_of(design, joint, kind), level, options, certify_boxes(span(boxes)), progress);
}

Certification certify_path(const Input& design, Joint joint, const Input& pieces, const Input& middle,
                           const Input& spans, Kind kind, double level, const Options& options,
                           const nb::object& progress) {
  if (pieces.ndim() != 3 || pieces.shape(1) != 6 || pieces.shape(2) < 1)
    throw std::invalid_argument("pieces must have shape (n, 6, powers)");
  Task task = task_of(design, joint, kind);
  task.pieces = pieces.data(), task.powers = static_cast<int>(pieces.shape(2));
  std::copy_n(rows(middle, 1, 9, "middle"), 9, task.middle);
  return run(task, level, options, certify_spans(span(spans), pieces.shape(0)), progress);
}

void bind_options(nb::module_& m) {
  nb::class_<Options> options(m, "CertificateOptions");
  options.def("__init__", [](Options* self) { new (self) Options(); });
  options.def(
      "__init__",
      [](Options* self, double gap, const std::optional<Limits>& limits, double seconds, double max_boxes, int threads,
         double cut, const Input& strays, const Input& payload, const Input& home) {
        new (self) Options{{gap, seconds, max_boxes, threads, cut}, limits};
        self->set_strays(strays, payload, home);
      },
      nb::kw_only(), "gap"_a, "limits"_a.none(), "seconds"_a, "max_boxes"_a, "threads"_a, "cut"_a, "strays"_a,
      "payload"_a, "home"_a);
  options.def_rw("gap", &Options::gap)
      .def_rw("limits", &Options::limits, nb::arg().none())
      .def_rw("seconds", &Options::seconds)
      .def_rw("max_boxes", &Options::max_boxes)
      .def_rw("threads", &Options::threads)
      .def_rw("cut", &Options::cut);
}

}  // namespace

void bind_certify(nb::module_& m) {
  m.attr("stray_numbers") = stray_numbers;
  nb::enum_<Kind>(m, "CertificateKind")
      .value("index", Kind::index)
      .value("regular", Kind::regular)
      .value("condition", Kind::condition)
      .value("limits", Kind::limits);
  nb::enum_<CertificateStatus>(m, "CertificateStatus")
      .value("proved", CertificateStatus::proved)
      .value("refuted", CertificateStatus::refuted)
      .value("undecided", CertificateStatus::undecided);
  nb::enum_<BrokenLimit> broken(m, "BrokenLimit");
#define FLEXAPOD_VALUE(name) broken.value(#name, BrokenLimit::name);
  FLEXAPOD_BROKEN_LIMITS(FLEXAPOD_VALUE)
  bind_options(m);
  nb::class_<Certification> result(m, "Certification");
  result.def_ro("status", &Certification::status)
      .def_ro("level", &Certification::level)
      .def_ro("value", &Certification::value)
      .def_ro("broken", &Certification::broken)
      .def_ro("leg", &Certification::leg)
      .def_ro("boxes", &Certification::boxes)
      .def_ro("proved", &Certification::proved)
      .def_ro("outside", &Certification::outside)
      .def_ro("seconds", &Certification::seconds);
  show(result, "at", &Certification::at);
  show(result, "remaining", &Certification::remaining);
  m.def("certify", &certify, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg().none());
  m.def("certify_path", &certify_path, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(),
        nb::arg(), nb::arg().none());
}

}  // namespace flexapod
