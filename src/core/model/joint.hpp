// How a leg may turn about itself. The name is shared by kernels that are compiled for different instruction sets.
#pragma once

namespace core_enums {

enum class Joint {
  universal,  // exact: a universal joint lets the leg spin about itself as the base axis k demands
  spin_free   // the paper's W.s = 0 (corrections, part B)
};

}  // namespace core_enums

namespace flexapod {

using core_enums::Joint;

}  // namespace flexapod
