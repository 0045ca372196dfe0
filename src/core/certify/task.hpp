// What a certificate is asked for and what is found of a box: plain data, shared by kernels that are compiled for
// different instruction sets.
#pragma once

#include <cstddef>

#include "sweep/task.hpp"

namespace certify_task {

inline constexpr int most_strays = 40;

enum class Kind {
  index,      // omega_1 is not below the level
  regular,    // no singular pose
  condition,  // cond(H) is not above the level
  limits      // lengths, angles and distances keep their limits
};

/// The six coordinates (position, m; roll, pitch, yaw, rad) between two ends each; on a path the first only, which is the
/// parameter of a piece.
struct Box {
  double low[6], high[6];
  int piece;       // of the path
  int sign;        // of det H at `seen`, a point of a box that this one was cut from; 0 where none is known
  double seen[6];  // coordinates
  double share;    // of the volume of all
  bool probe;      // a point that may break what is to be proved; not a part of what is asked for
};

struct Task {
  const double* design;  // its numbers, as in model/design.hpp
  core_enums::Joint joint;
  Kind kind;
  const sweep_task::Limits* limits;  // null: none
  // Numbers that stray: what each of `strays` variables from -1 to 1 adds to those of the design and to the place of its
  // payload. Limits are then what is to be proved, or none.
  const double* reach;  // (strays, numbers of a design and 3)
  int strays;
  double payload[4];   // where something strays: mass and place of a load on the platform beside the design's
  const double* home;  // (12,), position and matrix: where joints are in the middle; null: their middle does not stray
  // A path: polynomials of a piece's parameter for position and rotation vector e, R = exp(e) middle; null for boxes.
  const double* pieces;  // (pieces, 6, powers), the lowest power first
  int powers;
  double middle[9];  // by rows
};

// LIMIT(name): what a pose may break, in words with underscores. The last is no limit of the design.
#define FLEXAPOD_BROKEN_LIMITS(LIMIT)  \
  LIMIT(length)                        \
  LIMIT(universal_joint)               \
  LIMIT(spherical_joint)               \
  LIMIT(distance)                      \
  LIMIT(moment_in_the_universal_joint) \
  LIMIT(moment_in_the_spherical_joint) \
  LIMIT(stiffness_law)
#define FLEXAPOD_NAMED(name) name,
enum class BrokenLimit { FLEXAPOD_BROKEN_LIMITS(FLEXAPOD_NAMED) };
#undef FLEXAPOD_NAMED

enum class Verdict {
  proved,
  outside,  // all poses break a limit
  open,     // neither; it may be cut along `axis`
  broken    // the centre breaks what is to be proved
};

struct Finding {
  Verdict verdict;
  int axis;         // -1: the box is too small to be cut
  double value;     // at the centre: omega_1, cond(H); NaN where there is none
  int sign;         // of det H at the centre; 0 where it is nearly singular
  int limit, leg;   // a `BrokenLimit` that the centre breaks, of a leg or a pair; or -1
  double pose[12];  // the centre: position, matrix by rows
  bool hopeless;    // what strays is too much at the centre already: no box about it can be proved
  bool probe;       // whether `corner` may break what is to be proved
  double corner[6];
};

/// A kernel compiled for one instruction set. `memory`, of `size` bytes at an address divisible by 64, belongs to one
/// thread between `prepare` and `finish`.
struct Kernel {
  int lanes;  // boxes that are looked at together
  std::size_t size;
  void (*prepare)(const Task& task, void* memory);
  void (*look)(void* memory, double level, const Box* boxes, int count, Finding* found);
  void (*finish)(void* memory);
};

}  // namespace certify_task
