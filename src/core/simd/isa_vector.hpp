// A std::vector whose code belongs to this build of the core. Files that are compiled once for each instruction set must
// not share functions: the linker would let one compiled for a newer processor serve an older one. Those of
// std::vector<double> would be shared, so the allocator has a type of this namespace.
#pragma once

#include <memory>
#include <vector>

namespace flexapod {

template <class T> struct Allocator : std::allocator<T> {
  Allocator() = default;
  template <class U> Allocator(const Allocator<U>&) {}  // NOLINT: allocators of all types are one
  template <class U> struct rebind {
    using other = Allocator<U>;
  };
};

template <class T> using List = std::vector<T, Allocator<T>>;

}  // namespace flexapod
