#include "common/messages/wire.h"

#include <stdexcept>

namespace nbs {

void WireWriter::Overflow() { throw std::out_of_range("WireWriter: a number does not fit its field"); }

void WireWriter::String(const std::string& value) {
  Integer<int32_t>(value.size() + 1);
  bytes_.insert(bytes_.end(), value.begin(), value.end());
  bytes_.push_back(0);
}

void WireReader::String(std::string& value) {
  const size_t length = Count(0);
  if (!refusal_.empty()) return;
  if (length == 0 || data_[position_ + length - 1] != 0) return Refuse("a string has no end");
  const auto first = data_.begin() + static_cast<std::ptrdiff_t>(position_);
  value.assign(first, first + static_cast<std::ptrdiff_t>(length - 1));
  position_ += length;
}

size_t WireReader::Count(size_t /*unused*/) {
  int32_t count = 0;
  Integer<int32_t>(count);
  if (!refusal_.empty()) return 0;
  if (count < 0 || static_cast<size_t>(count) > remaining()) {
    Refuse("a length does not fit the data");
    return 0;
  }
  return static_cast<size_t>(count);
}

void WireReader::Refuse(std::string why) {
  if (refusal_.empty()) refusal_ = std::move(why);
  position_ = data_.size();
}

}  // namespace nbs
