#include "common/config/yaml_tree.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/runtime/error.h"

namespace nbs {
namespace {

constexpr int kMaxDepth = 20;

[[noreturn]] void Fail(const std::filesystem::path& file, int line, const std::string& text) {
  throw ConfigError(file.string() + ":" + std::to_string(line) + ": " + text);
}

YamlTree MakeTree(const std::filesystem::path& file, const YAML::Node& node, int depth) {
  YamlTree tree;
  tree.line = std::max(0, node.Mark().line) + 1;
  // An anchor that contains itself would otherwise recurse for ever.
  if (depth > kMaxDepth) Fail(file, tree.line, "nested more than " + std::to_string(kMaxDepth) + " levels deep");
  if (node.IsScalar()) {
    tree.kind = YamlTree::Kind::kScalar;
    tree.text = node.Scalar();
  } else if (node.IsSequence()) {
    tree.kind = YamlTree::Kind::kList;
    for (const YAML::Node& item : node) tree.items.push_back(MakeTree(file, item, depth + 1));
  } else if (node.IsMap()) {
    tree.kind = YamlTree::Kind::kMap;
    for (const auto& entry : node) {
      const YAML::Node& key = entry.first;
      const int line = key.Mark().line + 1;
      if (!key.IsScalar()) Fail(file, line, "a key must be a word");
      for (size_t i = 0; i < tree.keys.size(); ++i) {
        if (tree.keys[i] != key.Scalar()) continue;
        Fail(file, line,
             "key `" + key.Scalar() + "` comes twice: the first is on line " + std::to_string(tree.key_lines[i]));
      }
      tree.keys.push_back(key.Scalar());
      tree.items.push_back(MakeTree(file, entry.second, depth + 1));
      tree.key_lines.push_back(line);
    }
  }
  return tree;
}

std::string ReadText(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw ConfigError(file.string() + ": is a directory, not a YAML file");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw ConfigError(file.string() + ": cannot be read: " + std::strerror(errno));
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

YamlTree ReadYamlTree(const std::filesystem::path& file) {
  const std::string text = ReadText(file);
  try {
    return MakeTree(file, YAML::Load(text), 0);
  } catch (const YAML::Exception& error) {
    Fail(file, error.mark.line + 1, "no valid YAML: " + error.msg);
  }
}

std::string QuoteYaml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      quoted += code;
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

}  // namespace nbs
