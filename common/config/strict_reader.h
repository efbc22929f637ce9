#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/yaml_tree.h"
#include "common/geometry/pose.h"

namespace nbs {

/// What a number must lie in.
struct Range {
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool above_min = false;  ///< True: min itself is excluded.
  bool below_max = false;  ///< True: max itself is excluded.
};

/// Reads one map of a YAML file with no mercy: a key that is not listed, a value of the wrong kind or out of range, or
/// (where every key is required) a missing key end in a ConfigError of one sentence with file and line.
///
/// Each Read leaves `value` untouched where the key is absent and may be.
class StrictReader {
 public:
  enum class Missing { kKeepsDefault, kIsAnError };

  /// @param tree  Must outlive the reader.
  /// @throws ConfigError if the tree is no map, or has a key that is not in `keys` ("did you mean …").
  StrictReader(const std::filesystem::path& file, const YamlTree& tree, std::vector<std::string_view> keys,
               Missing missing);

  void Read(std::string_view key, double& value, const Range& range) const;
  void Read(std::string_view key, int& value, int min, int max) const;
  void Read(std::string_view key, int64_t& value) const;
  void Read(std::string_view key, uint64_t& value) const;
  void Read(std::string_view key, std::string& value) const;
  void Read(std::string_view key, Eigen::Vector3d& value) const;
  void Read(std::string_view key, Eigen::Vector2d& value) const;
  void Read(std::string_view key, Eigen::Vector3i& value, int min, int max) const;
  /// A list of any length.
  void Read(std::string_view key, std::vector<double>& value) const;
  /// A map of `position_m` and either `rpy_rad` (turns about the fixed x, y, z axes in this order, as in URDF) or
  /// `rotation` (a matrix by rows, which keeps every bit).
  void Read(std::string_view key, Pose& value) const;
  /// One of a few words.
  void ReadChoice(std::string_view key, std::string_view what, std::span<const std::string_view> choices,
                  std::string& value) const;

  /// The value under a key; nullptr where it is absent or null.
  const YamlTree* Find(std::string_view key) const;

  /// A reader for a map inside this one's file.
  StrictReader Inner(const YamlTree& tree, std::vector<std::string_view> keys, Missing missing) const;

  /// @throws ConfigError always: `text` with file and the line of the key (of the map where the key is absent).
  [[noreturn]] void Fail(std::string_view key, const std::string& text) const;

 private:
  const YamlTree* FindScalar(std::string_view key) const;
  const YamlTree* FindList(std::string_view key, size_t size) const;
  const YamlTree* FindPresent(std::string_view key) const;
  double ParseNumber(std::string_view key, const YamlTree& scalar) const;
  template <typename Integer>
  Integer ParseInteger(std::string_view key, const YamlTree& scalar) const;
  [[noreturn]] void FailAt(int line, const std::string& text) const;

  std::filesystem::path file_;
  const YamlTree* tree_;
  Missing missing_;
};

}  // namespace nbs
