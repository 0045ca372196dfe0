#include "bench/flop_counter.hpp"
#include "bindings/sweep.hpp"
#include "sweep/frequencies.hpp"

namespace flexapod {

double count_flops(const sweep_task::Task& task, size_t n) {
  Counted::count = 0;
  Sweep<Counted>(task).run(0, n);
  return static_cast<double>(Counted::count);
}

}  // namespace flexapod
