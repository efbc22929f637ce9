#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nbs {

/// A YAML document as plain values: what the strict reader works on.
struct YamlTree {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  int line = 1;                   ///< Where the value begins, from 1.
  std::string text;               ///< Of a scalar.
  std::vector<YamlTree> items;    ///< Of a list: its items. Of a map: its values, in the file's order.
  std::vector<std::string> keys;  ///< Of a map: a key for each item; none comes twice.
  std::vector<int> key_lines;     ///< Of a map: the line of each key.
};

/// Reads a YAML file.
///
/// @throws ConfigError, one sentence that begins with "FILE:LINE: " or "FILE: ", if the file cannot be read, is no
/// YAML, or has the same key twice in one map.
YamlTree ReadYamlTree(const std::filesystem::path& file);

/// `text` as a double-quoted YAML scalar that reads back equal.
std::string QuoteYaml(const std::string& text);

}  // namespace nbs
