// How a leg's axial stiffness follows from its length. The name is shared by kernels that are compiled for different
// instruction sets.
#pragma once

namespace core_enums {

/// A design holds it as a number, `Design::law`.
enum class Law { constant = 0, screw = 1, hydraulic = 2, table = 3 };

}  // namespace core_enums

namespace flexapod {

using core_enums::Law;

}  // namespace flexapod
