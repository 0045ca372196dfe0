// For benchmarks/sweep.py only: the work that a pose takes, and what the processor can do at most.
//     flexapod_bench flops QUANTITIES   reads a design and poses (rows of six) as raw doubles; prints operations a pose
//     flexapod_bench peak ISA ROUNDS    prints multiplications and additions a second of one thread
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "bench/flop_counter.hpp"
#include "kernels/isa.hpp"
#include "sweep/batch.hpp"
#include "sweep/frequencies.hpp"

#define FLEXAPOD_PEAK_OF(isa)                         \
  namespace flexapod_##isa {                          \
    extern double (*const peak_flops)(size_t rounds); \
  }
#if defined(FLEXAPOD_AVX512)
FLEXAPOD_PEAK_OF(avx512)
#endif
#if defined(FLEXAPOD_AVX2)
FLEXAPOD_PEAK_OF(avx2)
#endif
FLEXAPOD_PEAK_OF(baseline)

namespace {

using namespace flexapod;

/// A kernel that counts; each pose by itself, so that no lane is filled up.
void count(const sweep_task::Task& task, size_t first, size_t last) {
  const Features features(*reinterpret_cast<const Design<double>*>(task.design));
  if (features.others()) Sweep<Counted, Swept::others>(task).run(first, last);
  else Sweep<Counted, Swept::along_legs>(task).run(first, last);
}

int flops(unsigned quantities) {
  std::vector<double> numbers;
  for (double x; std::fread(&x, sizeof x, 1, stdin) == 1;) numbers.push_back(x);
  if (numbers.size() < design_size + 6 || (numbers.size() - design_size) % 6 != 0) return 1;
  const size_t n = (numbers.size() - design_size) / 6;
  const sweep_task::Limits limits = no_limits();
  sweep_task::Task task{};
  task.design = numbers.data(), task.joint = Joint::universal;
  task.poses = poses_in_rows(numbers.data() + design_size, 6);
  task.quantities = quantities, task.limits = &limits;
  sweep({"counter", nullptr, &count, nullptr}, task, n, 1);
  std::printf("%.17g\n", static_cast<double>(Counted::count) / static_cast<double>(n));
  return 0;
}

int peak(const std::string& isa, size_t rounds) {
  double (*run)(size_t) = nullptr;
#if defined(FLEXAPOD_AVX512)
  if (isa == "avx512") run = flexapod_avx512::peak_flops;
#endif
#if defined(FLEXAPOD_AVX2)
  if (isa == "avx2") run = flexapod_avx2::peak_flops;
#endif
  if (isa == "baseline") run = flexapod_baseline::peak_flops;
  if (run == nullptr) return 1;
  const auto start = std::chrono::steady_clock::now();
  const double done = run(rounds);
  std::printf("%.17g\n", done / std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return 0;
}

}  // namespace

int main(int count, char** words) {
  const std::string what = count > 1 ? words[1] : "";
  if (what == "flops" && count == 3) return flops(static_cast<unsigned>(std::atoi(words[2])));
  if (what == "peak" && count == 4) return peak(words[2], std::strtoull(words[3], nullptr, 10));
  std::fprintf(stderr, "flops QUANTITIES, or peak ISA ROUNDS\n");
  return 2;
}
