// The core as Python sees it.
#include "bindings/bind.hpp"

NB_MODULE(_core, m) {
  m.doc() = "Flexapod's mechanics: compiled functions of a design and of motions.";
  nanobind::set_leak_warnings(false);  // a design that is there to the end of the process keeps what was made of it
  flexapod::bind_types(m);
  flexapod::bind_mechanics(m);
  flexapod::bind_one_pose(m);
  flexapod::bind_rotations(m);
  flexapod::bind_sweep(m);
  flexapod::bind_certify(m);
  flexapod::bind_designs(m);
  flexapod::bind_simulation(m);
}
