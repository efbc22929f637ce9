#include "common/config/strict_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "common/config/suggestion.h"
#include "common/runtime/error.h"

namespace nbs {
namespace {

std::string Name(std::string_view key) { return std::string("`").append(key).append("`"); }

std::string ToText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string Explain(const Range& range) {
  const bool open_below = range.min == -std::numeric_limits<double>::max();
  const bool open_above = range.max == std::numeric_limits<double>::max();
  std::string text;
  if (!open_below) text += (range.above_min ? "above " : "at least ") + ToText(range.min);
  if (!open_below && !open_above) text += " and ";
  if (!open_above) text += (range.below_max ? "below " : "at most ") + ToText(range.max);
  return text;
}

}  // namespace

StrictReader::StrictReader(const std::filesystem::path& file, const YamlTree& tree, std::vector<std::string_view> keys,
                           Missing missing)
    : file_(file), tree_(&tree), missing_(missing) {
  if (tree.kind != YamlTree::Kind::kMap) FailAt(tree.line, "must be a map of keys and values");
  for (size_t i = 0; i < tree.keys.size(); ++i) {
    const std::string& key = tree.keys[i];
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      FailAt(tree.key_lines[i], ExplainUnknown("key", key, keys));
  }
}

void StrictReader::FailAt(int line, const std::string& text) const {
  throw ConfigError(file_.string() + ":" + std::to_string(line) + ": " + text);
}

void StrictReader::Fail(std::string_view key, const std::string& text) const {
  for (size_t i = 0; i < tree_->keys.size(); ++i) {
    if (tree_->keys[i] == key) FailAt(tree_->key_lines[i], text);
  }
  FailAt(tree_->line, text);
}

const YamlTree* StrictReader::FindPresent(std::string_view key) const {
  for (size_t i = 0; i < tree_->keys.size(); ++i) {
    if (tree_->keys[i] == key) return &tree_->items[i];
  }
  if (missing_ == Missing::kIsAnError) Fail(key, "key " + Name(key) + " is missing");
  return nullptr;
}

const YamlTree* StrictReader::Find(std::string_view key) const {
  const YamlTree* value = FindPresent(key);
  return value && value->kind != YamlTree::Kind::kNull ? value : nullptr;
}

const YamlTree* StrictReader::FindScalar(std::string_view key) const {
  const YamlTree* value = FindPresent(key);
  if (value && value->kind != YamlTree::Kind::kScalar) Fail(key, Name(key) + " must be one value");
  return value;
}

const YamlTree* StrictReader::FindList(std::string_view key, size_t size) const {
  const YamlTree* value = FindPresent(key);
  if (!value) return nullptr;
  bool good = value->kind == YamlTree::Kind::kList && value->items.size() == size;
  for (const YamlTree& item : value->items) good = good && item.kind == YamlTree::Kind::kScalar;
  if (!good) Fail(key, Name(key) + " must be a list of " + std::to_string(size) + " numbers");
  return value;
}

double StrictReader::ParseNumber(std::string_view key, const YamlTree& scalar) const {
  const char* first = scalar.text.data();
  const char* last = first + scalar.text.size();
  if (first != last && *first == '+') ++first;
  double number = 0.0;
  const auto [end, error] = std::from_chars(first, last, number);
  if (error != std::errc() || end != last || !std::isfinite(number)) {
    FailAt(scalar.line, Name(key) + " must be a finite number, not `" + scalar.text + "`");
  }
  return number;
}

template <typename Integer>
Integer StrictReader::ParseInteger(std::string_view key, const YamlTree& scalar) const {
  const char* last = scalar.text.data() + scalar.text.size();
  Integer number = 0;
  const auto [end, error] = std::from_chars(scalar.text.data(), last, number);
  if (error != std::errc() || end != last) {
    const std::string what = std::is_signed_v<Integer> ? " must be a whole number" : " must be a whole number from 0";
    FailAt(scalar.line, Name(key) + what + (error == std::errc::result_out_of_range ? " of 64 bits" : "") + ", not `" +
                            scalar.text + "`");
  }
  return number;
}

void StrictReader::Read(std::string_view key, double& value, const Range& range) const {
  const YamlTree* scalar = FindScalar(key);
  if (!scalar) return;
  const double number = ParseNumber(key, *scalar);
  const bool good = (range.above_min ? number > range.min : number >= range.min) &&
                    (range.below_max ? number < range.max : number <= range.max);
  if (!good) FailAt(scalar->line, Name(key) + " must be " + Explain(range) + ", not " + scalar->text);
  value = number;
}

void StrictReader::Read(std::string_view key, int& value, int min, int max) const {
  const YamlTree* scalar = FindScalar(key);
  if (!scalar) return;
  const int64_t number = ParseInteger<int64_t>(key, *scalar);
  if (number < min || number > max) {
    FailAt(scalar->line, Name(key) + " must be a whole number from " + std::to_string(min) + " to " +
                             std::to_string(max) + ", not " + scalar->text);
  }
  value = static_cast<int>(number);
}

void StrictReader::Read(std::string_view key, int64_t& value) const {
  if (const YamlTree* scalar = FindScalar(key)) value = ParseInteger<int64_t>(key, *scalar);
}

void StrictReader::Read(std::string_view key, uint64_t& value) const {
  if (const YamlTree* scalar = FindScalar(key)) value = ParseInteger<uint64_t>(key, *scalar);
}

void StrictReader::Read(std::string_view key, std::string& value) const {
  if (const YamlTree* scalar = FindScalar(key)) value = scalar->text;
}

void StrictReader::Read(std::string_view key, Eigen::Vector3d& value) const {
  const YamlTree* list = FindList(key, 3);
  if (!list) return;
  for (int i = 0; i < 3; ++i) value[i] = ParseNumber(key, list->items[i]);
}

void StrictReader::Read(std::string_view key, Eigen::Vector2d& value) const {
  const YamlTree* list = FindList(key, 2);
  if (!list) return;
  for (int i = 0; i < 2; ++i) value[i] = ParseNumber(key, list->items[i]);
}

void StrictReader::Read(std::string_view key, std::vector<double>& value) const {
  const YamlTree* list = FindPresent(key);
  if (!list) return;
  if (list->kind != YamlTree::Kind::kList) FailAt(list->line, Name(key) + " must be a list of numbers");
  value.clear();
  for (const YamlTree& item : list->items) value.push_back(ParseNumber(key, item));
}

void StrictReader::Read(std::string_view key, Eigen::Vector3i& value, int min, int max) const {
  const YamlTree* list = FindList(key, 3);
  if (!list) return;
  for (int i = 0; i < 3; ++i) {
    const int64_t number = ParseInteger<int64_t>(key, list->items[i]);
    if (number < min || number > max)
      Fail(key, Name(key) + " must lie from " + std::to_string(min) + " to " + std::to_string(max));
    value[i] = static_cast<int>(number);
  }
}

void StrictReader::Read(std::string_view key, Pose& value) const {
  const YamlTree* tree = FindPresent(key);
  if (!tree) return;
  const StrictReader reader = Inner(*tree, {"position_m", "rpy_rad", "rotation"}, Missing::kKeepsDefault);
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  reader.Read("position_m", position);
  Pose X = Pose::Identity();
  const YamlTree* rows = reader.Find("rotation");
  if (rows) {
    if (reader.Find("rpy_rad")) reader.Fail("rotation", "give `rpy_rad` or `rotation`, not both");
    if (rows->kind != YamlTree::Kind::kList || rows->items.size() != 9)
      reader.Fail("rotation", "`rotation` must be a list of 9 numbers, row by row");
    for (int i = 0; i < 9; ++i) X.linear()(i / 3, i % 3) = reader.ParseNumber("rotation", rows->items[i]);
  } else {
    Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
    reader.Read("rpy_rad", rpy);
    X.linear() =
        (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
  }
  X.translation() = position;
  if (!IsRigid(X))
    reader.Fail("rotation", "`rotation` is no rotation: its rows must be unit vectors at right angles, right-handed");
  value = X;
}

void StrictReader::ReadChoice(std::string_view key, std::string_view what, std::span<const std::string_view> choices,
                              std::string& value) const {
  const YamlTree* scalar = FindScalar(key);
  if (!scalar) return;
  if (std::find(choices.begin(), choices.end(), scalar->text) == choices.end())
    FailAt(scalar->line, ExplainUnknown(what, scalar->text, choices));
  value = scalar->text;
}

StrictReader StrictReader::Inner(const YamlTree& tree, std::vector<std::string_view> keys, Missing missing) const {
  return StrictReader(file_, tree, std::move(keys), missing);
}

}  // namespace nbs
