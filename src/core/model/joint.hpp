// How a leg may turn about itself. The name is shared by kernels that are compiled for different instruction sets.
#pragma once

namespace core_enums {

/// Python may give a number for an enumerator: True, given by mistake, then is the universal joint.
enum class Joint {
  universal = 1,  // exact: a universal joint lets the leg spin about itself as the base axis k demands
  spin_free = 0   // the paper's W.s = 0 (corrections, part B)
};

}  // namespace core_enums

namespace flexapod {

using core_enums::Joint;

}  // namespace flexapod
