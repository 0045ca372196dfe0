// Arrays of results that know their shape. Only for code that is compiled once, not for each instruction set.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace flexapod {

/// A new array; its numbers are not set unless a value is given.
template <class T = double> class Array {
 public:
  explicit Array(std::vector<std::size_t> shape) : shape_(std::move(shape)) {
    size_ = 1;
    for (const std::size_t n : shape_) size_ *= n;
    data_ = std::make_unique_for_overwrite<T[]>(std::max<std::size_t>(size_, 1));
  }
  Array(std::vector<std::size_t> shape, T value) : Array(std::move(shape)) { std::fill_n(data(), size_, value); }

  T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  const std::vector<std::size_t>& shape() const { return shape_; }
  std::unique_ptr<T[]> release() { return std::move(data_); }

 private:
  std::vector<std::size_t> shape_;
  std::size_t size_;
  std::unique_ptr<T[]> data_;
};

}  // namespace flexapod
