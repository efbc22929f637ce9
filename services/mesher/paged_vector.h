#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace nbs {

/// A vector that grows by pages of equal size: nothing is moved when it grows, and little is held in store.
template <typename T>
class PagedVector {
 public:
  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  T& operator[](size_t i) { return (*pages_[i >> kShift])[i & kMask]; }
  const T& operator[](size_t i) const { return (*pages_[i >> kShift])[i & kMask]; }
  T& back() { return (*this)[size_ - 1]; }

  /// Adds a T{} and returns it.
  T& Append() {
    if (size_ >> kShift == pages_.size()) pages_.push_back(std::make_unique<Page>());
    return (*this)[size_++];
  }
  void push_back(const T& value) { Append() = value; }

  /// New elements are T{}.
  void GrowTo(size_t size) {
    while (size_ < size) Append();
  }

  class Iterator {
   public:
    Iterator(const PagedVector* vector, size_t i) : vector_(vector), i_(i) {}
    const T& operator*() const { return (*vector_)[i_]; }
    Iterator& operator++() {
      ++i_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return i_ != other.i_; }

   private:
    const PagedVector* vector_;
    size_t i_;
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size_}; }

 private:
  static constexpr size_t kShift = 8, kMask = (size_t{1} << kShift) - 1;
  using Page = std::array<T, kMask + 1>;
  std::vector<std::unique_ptr<Page>> pages_;
  size_t size_ = 0;
};

}  // namespace nbs
