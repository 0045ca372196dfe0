// A certificate over boxes on several threads: depth first, each thread on boxes of its own, which it shares with those
// that have none.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <iterator>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <vector>

#include "certify/task.hpp"
#include "numbers/array.hpp"

namespace flexapod {

struct CertifyOptions {
  double gap = 0.0;
  double seconds = std::numeric_limits<double>::infinity();
  double max_boxes = std::numeric_limits<double>::infinity();
  int threads = 1;
  double cut = 0.5;
};

enum class CertificateStatus { proved, refuted, undecided };

class CertifySearch {
 public:
  using Box = certify_task::Box;
  using Finding = certify_task::Finding;
  using Kind = certify_task::Kind;
  using Verdict = certify_task::Verdict;

  CertifySearch(const certify_task::Kernel& kernel, const certify_task::Task& task, double level,
                const CertifyOptions& options, std::vector<Box> boxes)
      : kernel_(kernel), task_(task), options_(options), start_(Clock::now()), best_(level), shared_(std::move(boxes)) {
    if (options.threads < 1) throw std::invalid_argument("threads is not >= 1");
    if (!(options.cut >= 0.3 && options.cut <= 0.7)) throw std::invalid_argument("cut is not from 0.3 to 0.7");
    if (!(options.gap >= 0.0 && options.gap < 1.0)) throw std::invalid_argument("gap is not from 0 to 1");
    threads_ = options.threads;
  }

  /// The work of one thread.
  void run(const std::atomic<bool>& stop) {
    const Memory memory(kernel_, task_);
    std::vector<Box> mine;
    std::vector<Finding> found(kernel_.lanes);
    while (!stop && take(mine, stop)) {
      const int count = std::min<int>(kernel_.lanes, static_cast<int>(mine.size()));
      const Box* boxes = mine.data() + mine.size() - count;
      const std::vector<Box> taken(boxes, boxes + count);
      kernel_.look(memory.get(), target(), taken.data(), count, found.data());
      mine.resize(mine.size() - count);
      for (int i = 0; i < count; ++i) settle(memory.get(), taken[i], found[i], mine);
      looked_ += count;
      if (ended()) finish();
      give(mine);
    }
    give_back(mine);
  }

  /// The share of the volume that is decided.
  double done() const { return proved_ + outside_; }
  double proved() const { return proved_; }
  double outside() const { return outside_; }
  std::size_t boxes() const { return looked_; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  // When all threads have ended:
  CertificateStatus status() const {
    if (refuted_) return CertificateStatus::refuted;
    return remaining().empty() ? CertificateStatus::proved : CertificateStatus::undecided;
  }
  std::vector<Box> remaining() const {
    std::vector<Box> all = stuck_;
    std::copy_if(shared_.begin(), shared_.end(), std::back_inserter(all), [](const Box& box) { return !box.probe; });
    return all;
  }
  double level() const { return target(); }
  double value() const { return value_; }
  const Finding& at() const { return at_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// A kernel's memory for one thread.
  class Memory {
   public:
    Memory(const certify_task::Kernel& kernel, const certify_task::Task& task)
        : kernel_(kernel), bytes_(new std::byte[kernel.size + 64]) {
      std::size_t space = kernel.size + 64;
      at_ = bytes_.get();
      std::align(64, kernel.size, at_, space);
      kernel.prepare(task, at_);
    }
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory() { kernel_.finish(at_); }
    void* get() const { return at_; }

   private:
    const certify_task::Kernel& kernel_;
    std::unique_ptr<std::byte[]> bytes_;
    void* at_;
  };

  static constexpr double smallest = 0x1p-40;  // share of a path's parameters below which a span is not cut
  static constexpr std::size_t most_stuck = 1000;
  static constexpr double tried = 0x1p-12;  // share above which it is seen whether a box's centre can be proved

  const certify_task::Kernel& kernel_;
  const certify_task::Task task_;
  const CertifyOptions options_;
  const Clock::time_point start_;
  std::atomic<double> best_, proved_{0.0}, outside_{0.0};
  std::atomic<double> worst_{std::numeric_limits<double>::quiet_NaN()};  // value_, to be read without a lock
  std::atomic<std::size_t> looked_{0};
  std::atomic<bool> over_{false}, hungry_{false};

  std::mutex mutex_;
  std::condition_variable more_;
  std::vector<Box> shared_, stuck_;
  int threads_, waiting_ = 0;
  bool refuted_ = false;
  double value_ = std::numeric_limits<double>::quiet_NaN();
  Finding at_ = [] {
    Finding none{};
    none.limit = none.leg = -1;
    for (double& number : none.pose) number = std::numeric_limits<double>::quiet_NaN();
    return none;
  }();

  double target() const {
    const double best = best_;
    if (task_.kind == Kind::index) return best * (1.0 - options_.gap);
    if (task_.kind == Kind::condition) return best * (1.0 + options_.gap);
    return std::numeric_limits<double>::quiet_NaN();
  }
  bool ended() const { return static_cast<double>(looked_) >= options_.max_boxes || seconds() >= options_.seconds; }

  /// Fills an empty list from the shared one; waits for others. False where there is nothing left to do.
  bool take(std::vector<Box>& mine, const std::atomic<bool>& stop) {
    if (over_) return false;
    if (!mine.empty()) return true;
    std::unique_lock lock(mutex_);
    ++waiting_;
    hungry_ = true;
    while (shared_.empty() && !over_ && !stop && waiting_ < threads_)
      more_.wait_for(lock, std::chrono::milliseconds(20));
    if (shared_.empty() && waiting_ >= threads_) over_ = true, more_.notify_all();
    if (over_ || stop) return false;
    --waiting_;
    hungry_ = waiting_ > 0;
    const std::size_t some = std::min<std::size_t>(shared_.size(), kernel_.lanes);
    mine.insert(mine.end(), shared_.end() - some, shared_.end());
    shared_.resize(shared_.size() - some);
    return true;
  }
  /// The larger half of a list for those that wait.
  void give(std::vector<Box>& mine) {
    if (!hungry_ || mine.size() < 2) return;
    const std::size_t some = mine.size() / 2;
    const std::lock_guard lock(mutex_);
    shared_.insert(shared_.end(), mine.begin(), mine.begin() + some);
    mine.erase(mine.begin(), mine.begin() + some);
    more_.notify_all();
  }
  void give_back(const std::vector<Box>& mine) {
    const std::lock_guard lock(mutex_);
    shared_.insert(shared_.end(), mine.begin(), mine.end());
  }
  void finish() {
    const std::lock_guard lock(mutex_);
    over_ = true;
    more_.notify_all();
  }

  void settle(void* memory, const Box& box, const Finding& found, std::vector<Box>& mine) {
    if (found.value == found.value && found.limit < 0) note(found);
    if (box.sign * found.sign < 0 && task_.limits == nullptr) return refute(box, singular(memory, box, found));
    if (box.probe && found.verdict != Verdict::broken) {
      if (task_.strays > 0 && found.verdict == Verdict::open) finish();  // what cannot be proved of a point
      return;
    }
    switch (found.verdict) {
      case Verdict::proved:
        proved_ += box.share;
        break;
      case Verdict::outside:
        outside_ += box.share;
        break;
      case Verdict::open:
        if (found.hopeless) return give_up(box);
        cut(box, found, mine);
        if (found.probe) mine.push_back(probe(box, found.corner));  // next
        else if (task_.strays > 0 && box.share > tried) mine.push_back(probe(box, centre_of(box).data()));
        break;
      case Verdict::broken:
        if (options_.gap == 0.0 || found.limit >= 0) refute(box, found);
        else if (!box.probe) mine.push_back(box);  // once more, for the level that its centre has given
    }
  }

  /// Cutting does not help where a design's numbers stray too far.
  void give_up(const Box& box) {
    {
      const std::lock_guard lock(mutex_);
      stuck_.push_back(box);
    }
    finish();
  }

  static std::array<double, 6> centre_of(const Box& box) {
    std::array<double, 6> centre;
    for (int k = 0; k < 6; ++k) centre[k] = 0.5 * (box.low[k] + box.high[k]);
    return centre;
  }
  static Box probe(const Box& box, const double* at) {
    Box point = box;
    for (int k = 0; k < 6; ++k) point.low[k] = point.high[k] = at[k];
    point.share = 0.0, point.probe = true;
    return point;
  }

  /// The worst value of all centres; with a gap, the level follows it.
  void note(const Finding& found) {
    const auto worse = [&](double than) {
      return task_.kind == Kind::index ? !(found.value >= than) : !(found.value <= than);
    };
    double best = best_;
    while (options_.gap > 0.0 && worse(best) && !best_.compare_exchange_weak(best, found.value)) continue;
    if (!worse(worst_)) return;
    const std::lock_guard lock(mutex_);
    if (refuted_ || !worse(value_)) return;
    worst_ = value_ = found.value;
    at_ = found;
    at_.limit = at_.leg = -1;
  }

  void refute(const Box& box, const Finding& found) {
    {
      const std::lock_guard lock(mutex_);
      if (!box.probe) shared_.push_back(box);
      if (!refuted_) at_ = found, value_ = found.value;
      refuted_ = true;
    }
    finish();
  }

  void cut(const Box& box, const Finding& found, std::vector<Box>& mine) {
    const int i = found.axis;
    const double middle = i < 0 ? 0.0 : box.low[i] + options_.cut * (box.high[i] - box.low[i]);
    if (i < 0 || !(middle > box.low[i] && middle < box.high[i]) || (task_.pieces != nullptr && box.share < smallest)) {
      const std::lock_guard lock(mutex_);
      stuck_.push_back(box);
      if (stuck_.size() >= most_stuck) over_ = true;
      return;
    }
    Box below = box, above = box;
    below.high[i] = above.low[i] = middle;
    below.share = box.share * ((middle - box.low[i]) / (box.high[i] - box.low[i]));
    above.share = box.share - below.share;
    if (found.sign != 0)
      for (Box* half : {&below, &above}) {
        half->sign = found.sign;
        std::ranges::copy(centre_of(box), half->seen);
      }
    mine.push_back(below);
    mine.push_back(above);
  }

  /// The pose without rigidity between a box's centre and the point where det H had the other sign.
  Finding singular(void* memory, const Box& box, const Finding& found) const {
    Box point = box;
    std::array<double, 6> here = centre_of(box), there;
    std::ranges::copy(box.seen, there.begin());
    Finding last = found;
    for (int step = 0; step < 60; ++step) {
      for (int k = 0; k < 6; ++k) point.low[k] = point.high[k] = 0.5 * (here[k] + there[k]);
      kernel_.look(memory, target(), &point, 1, &last);
      if (last.sign == 0) break;
      for (int k = 0; k < 6; ++k) (last.sign == found.sign ? here : there)[k] = point.low[k];
    }
    return last;
  }
};

}  // namespace flexapod
