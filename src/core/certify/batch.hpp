// Boxes and spans in, a certificate out.
#pragma once

#include <span>
#include <string>

#include "certify/search.hpp"
#include "certify/strays.hpp"
#include "model/leg_distance.hpp"

namespace flexapod {

/// What was found, as arrays.
struct Certification {
  CertificateStatus status;
  double level, value;
  Array<double> at;  // (12,)
  int broken, leg;
  std::size_t boxes;
  double proved, outside;
  Array<double> remaining;  // (n, 6, 2) or (n, 3)
  double seconds;

  Certification(const CertifySearch& search, bool path)
      : status(search.status()),
        level(search.level()),
        value(search.value()),
        at({12}),
        broken(status == CertificateStatus::refuted ? search.at().limit : -1),
        leg(status == CertificateStatus::refuted ? search.at().leg : -1),
        boxes(search.boxes()),
        proved(search.proved()),
        outside(search.outside()),
        remaining(path ? spans(search.remaining()) : sides(search.remaining())),
        seconds(search.seconds()) {
    std::copy_n(search.at().pose, 12, at.data());
  }

 private:
  using Boxes = std::vector<certify_task::Box>;

  static Array<double> sides(const Boxes& boxes) {
    Array<double> rows({boxes.size(), 6, 2});
    double* to = rows.data();
    for (const certify_task::Box& box : boxes)
      for (int i = 0; i < 6; ++i) *to++ = box.low[i], *to++ = box.high[i];
    return rows;
  }
  static Array<double> spans(const Boxes& boxes) {
    Array<double> rows({boxes.size(), 3});
    double* to = rows.data();
    for (const certify_task::Box& box : boxes) *to++ = box.piece, *to++ = box.low[0], *to++ = box.high[0];
    return rows;
  }
};

/// Throws where legs share a joint that strays from itself: how far they are apart would begin anew.
inline void check_shared(const certify_task::Task& task, const Design<double>& design) {
  const SharedJoints shared(design);
  const auto together = [&](const Vec3<double>& one, const Vec3<double>& other) {
    for (int s = 0; s < task.strays; ++s) {
      const double* const row = task.reach + s * stray_numbers;
      if (!std::equal(row + number_of(design, one), row + number_of(design, one) + 3, row + number_of(design, other)))
        return false;
    }
    return true;
  };
  for_leg_pairs([&](int pair, int i, int j) {
    if ((shared.base[pair] && !together(design.b[i], design.b[j])) ||
        (shared.platform[pair] && !together(design.p[i], design.p[j])))
      throw std::invalid_argument("legs " + std::to_string(i) + " and " + std::to_string(j) +
                                  " share a joint, and its places stray apart");
  });
}

/// Throws where numbers are to stray that may not.
inline void check_strays(const certify_task::Task& task) {
  if (task.strays > certify_task::most_strays)
    throw std::invalid_argument("at most " + std::to_string(certify_task::most_strays) + " numbers may stray");
  if (task.strays > 0 && task.limits != nullptr && task.kind != certify_task::Kind::limits)
    throw std::invalid_argument("which poses count may not stray");
  const auto& design = *reinterpret_cast<const Design<double>*>(task.design);
  for (int k = 0; k < task.strays * stray_numbers; ++k)
    if (!(task.reach[k] == 0.0 || (std::isfinite(task.reach[k]) && may_stray(design, k % stray_numbers))))
      throw std::invalid_argument("number " + std::to_string(k % stray_numbers) + " of the design may not stray");
  if (task.strays > 0 && task.limits != nullptr && task.limits->leg_distance > 0.0) check_shared(task, design);
}

/// Gives each box its share of the volume, in those of `sides` coordinates that any box has a width in.
inline void share_out(std::vector<certify_task::Box>& boxes, int sides) {
  bool wide[6] = {};
  for (const auto& box : boxes)
    for (int i = 0; i < sides; ++i) {
      if (!(std::isfinite(box.low[i]) && std::isfinite(box.high[i]) && box.low[i] <= box.high[i]))
        throw std::invalid_argument("a box has ends that are not finite or not in order");
      wide[i] = wide[i] || box.high[i] > box.low[i];
    }
  double all = 0.0;
  for (auto& box : boxes) {
    box.share = 1.0;
    for (int i = 0; i < sides; ++i)
      if (wide[i]) box.share *= box.high[i] - box.low[i];
    all += box.share;
  }
  for (auto& box : boxes) box.share /= all;
}

/// Rows of (6, 2).
inline std::vector<certify_task::Box> certify_boxes(std::span<const double> rows) {
  if (rows.empty() || rows.size() % 12 != 0) throw std::invalid_argument("boxes must have shape (n, 6, 2), n >= 1");
  std::vector<certify_task::Box> boxes(rows.size() / 12);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    boxes[b] = {};
    for (int i = 0; i < 6; ++i) boxes[b].low[i] = rows[12 * b + 2 * i], boxes[b].high[i] = rows[12 * b + 2 * i + 1];
  }
  share_out(boxes, 6);
  return boxes;
}

/// Rows of (piece, low, high).
inline std::vector<certify_task::Box> certify_spans(std::span<const double> rows, std::size_t pieces) {
  if (rows.empty() || rows.size() % 3 != 0) throw std::invalid_argument("spans must have shape (n, 3), n >= 1");
  std::vector<certify_task::Box> boxes(rows.size() / 3);
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const double piece = rows[3 * b];
    if (!(piece >= 0.0 && piece < static_cast<double>(pieces)))
      throw std::invalid_argument("a span is of piece " + std::to_string(piece) + "; there are " +
                                  std::to_string(pieces));
    boxes[b] = {};
    boxes[b].piece = static_cast<int>(piece), boxes[b].low[0] = rows[3 * b + 1], boxes[b].high[0] = rows[3 * b + 2];
  }
  share_out(boxes, 1);
  return boxes;
}

}  // namespace flexapod
