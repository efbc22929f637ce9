#include "common/geometry/ply_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>

namespace nbs {
namespace {

enum class Format { kAscii, kLittleEndian, kBigEndian };
enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
constexpr std::array<size_t, 8> kScalarBytes = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
  std::string_view name;
  bool is_list = false;
  Scalar count_type = Scalar::kUint8;
  Scalar type = Scalar::kFloat;
};

struct Element {
  std::string_view name;
  uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Format format = Format::kAscii;
  std::vector<Element> elements;
};

[[noreturn]] void Fail(const std::string& what) { throw std::runtime_error(what); }

constexpr bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// Cuts the next word off `text`; empty at its end.
std::string_view NextWord(std::string_view& text) {
  size_t begin = 0;
  while (begin < text.size() && IsBlank(text[begin])) ++begin;
  size_t end = begin;
  while (end < text.size() && !IsBlank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

/// Cuts the next line, without its end, off `text`.
std::string_view NextLine(std::string_view& text) {
  const size_t end = text.find('\n');
  if (end == std::string_view::npos) Fail("is cut short: its header does not end");
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

Scalar ParseScalar(std::string_view word) {
  constexpr std::array<std::string_view, 8> kOld = {"char", "uchar", "short", "ushort",
                                                    "int",  "uint",  "float", "double"};
  constexpr std::array<std::string_view, 8> kNew = {"int8",  "uint8",  "int16",   "uint16",
                                                    "int32", "uint32", "float32", "float64"};
  for (size_t i = 0; i < kOld.size(); ++i) {
    if (word == kOld[i] || word == kNew[i]) return static_cast<Scalar>(i);
  }
  Fail("has a property of unknown type `" + std::string(word) + "`");
}

Format ParseFormat(std::string_view word) {
  if (word == "ascii") return Format::kAscii;
  if (word == "binary_little_endian") return Format::kLittleEndian;
  if (word == "binary_big_endian") return Format::kBigEndian;
  Fail("has the unknown PLY format `" + std::string(word) + "`");
}

Property ParseProperty(std::string_view rest) {
  Property property;
  std::string_view word = NextWord(rest);
  if (word == "list") {
    property.is_list = true;
    property.count_type = ParseScalar(NextWord(rest));
    if (property.count_type >= Scalar::kFloat) Fail("has a list whose length is not a whole number");
    word = NextWord(rest);
  }
  property.type = ParseScalar(word);
  property.name = NextWord(rest);
  return property;
}

Element ParseElement(std::string_view rest) {
  Element element;
  element.name = NextWord(rest);
  const std::string_view word = NextWord(rest);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), element.count);
  if (error != std::errc() || end != word.data() + word.size()) {
    Fail("has an element count that is no number, `" + std::string(word) + "`");
  }
  return element;
}

/// Parses the header and leaves `text` at the first byte after it.
Header ParseHeader(std::string_view& text) {
  if (!text.starts_with("ply\n") && !text.starts_with("ply\r\n")) Fail("is not a PLY file");
  NextLine(text);
  Header header;
  bool has_format = false;
  while (true) {
    std::string_view rest = NextLine(text);
    const std::string_view key = NextWord(rest);
    if (key == "end_header") break;
    if (key == "comment" || key == "obj_info") continue;
    if (key == "format") {
      header.format = ParseFormat(NextWord(rest));
      has_format = true;
    } else if (key == "element") {
      header.elements.push_back(ParseElement(rest));
    } else if (key == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(ParseProperty(rest));
    } else {
      Fail("has an unknown line in its header, `" + std::string(key) + "`");
    }
  }
  if (!has_format) Fail("does not state its PLY format");
  return header;
}

/// Reads numbers one after the other.
class Body {
 public:
  Body(std::string_view text, Format format) : text_(text), format_(format) {}

  /// Fails early, before anything is allocated, if `count` things of at least one byte each cannot be left.
  void RequireAtLeast(uint64_t count) const {
    if (count > text_.size()) Fail("is cut short: it announces more than it holds");
  }

  double Next(Scalar type) { return format_ == Format::kAscii ? NextAscii() : NextBinary(type); }

 private:
  double NextAscii() {
    const std::string_view word = NextWord(text_);
    if (word.empty()) Fail("is cut short");
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    double value = 0.0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool too_large = error == std::errc::result_out_of_range && !IsSmall(digits);
    if (error == std::errc::invalid_argument || too_large || end != digits.data() + digits.size()) {
      Fail("has something else where a number should be, `" + std::string(word.substr(0, 20)) + "`");
    }
    return value;
  }

  /// Whether a number that no double can hold is too close to 0, and not too far from it.
  static bool IsSmall(std::string_view number) {
    return std::abs(std::strtod(std::string(number).c_str(), nullptr)) < 1.0;
  }

  template <typename T>
  double Take() {
    std::array<char, sizeof(T)> bytes;
    if (text_.size() < sizeof(T)) Fail("is cut short");
    std::memcpy(bytes.data(), text_.data(), sizeof(T));
    text_.remove_prefix(sizeof(T));
    if (format_ == Format::kBigEndian) std::reverse(bytes.begin(), bytes.end());
    return static_cast<double>(std::bit_cast<T>(bytes));
  }

  double NextBinary(Scalar type) {
    switch (type) {
      case Scalar::kInt8:
        return Take<int8_t>();
      case Scalar::kUint8:
        return Take<uint8_t>();
      case Scalar::kInt16:
        return Take<int16_t>();
      case Scalar::kUint16:
        return Take<uint16_t>();
      case Scalar::kInt32:
        return Take<int32_t>();
      case Scalar::kUint32:
        return Take<uint32_t>();
      case Scalar::kFloat:
        return Take<float>();
      case Scalar::kDouble:
        return Take<double>();
    }
    Fail("has a property of unknown type");
  }

  std::string_view text_;
  Format format_;
};

uint64_t NextListLength(Body& body, const Property& property) {
  const double length = body.Next(property.count_type);
  if (!(length >= 0.0 && length < 4294967296.0) || length != std::floor(length))
    Fail("has a list of impossible length");
  body.RequireAtLeast(static_cast<uint64_t>(length));
  return static_cast<uint64_t>(length);
}

void Skip(Body& body, const Property& property) {
  const uint64_t count = property.is_list ? NextListLength(body, property) : 1;
  for (uint64_t i = 0; i < count; ++i) body.Next(property.type);
}

/// Column of `name` among the properties, or -1.
int FindProperty(const Element& element, std::string_view name) {
  for (size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

void ParseVertices(const Element& element, Body& body, TriangleMesh& mesh) {
  constexpr std::array<std::string_view, 6> kNames = {"x", "y", "z", "nx", "ny", "nz"};
  std::vector<int> target(element.properties.size(), -1);
  int found = 0;
  for (int i = 0; i < 6; ++i) {
    const int column = FindProperty(element, kNames[i]);
    if (i < 3 && column < 0) Fail("has vertices without x, y and z");
    if (column < 0) continue;
    if (element.properties[column].is_list) Fail("has lists as vertex coordinates");
    target[column] = i;
    ++found;
  }
  body.RequireAtLeast(element.count);
  mesh.vertices_W.reserve(element.count);
  for (uint64_t v = 0; v < element.count; ++v) {
    std::array<float, 6> value{};
    for (size_t column = 0; column < target.size(); ++column) {
      if (target[column] < 0) {
        Skip(body, element.properties[column]);
      } else {
        value[target[column]] = static_cast<float>(body.Next(element.properties[column].type));
      }
    }
    mesh.vertices_W.emplace_back(value[0], value[1], value[2]);
    if (found == 6) mesh.normals_W.emplace_back(value[3], value[4], value[5]);
  }
}

uint32_t NextIndex(Body& body, Scalar type) {
  const double index = body.Next(type);
  if (!(index >= 0.0 && index < 4294967295.0) || index != std::floor(index))
    Fail("has a face with an impossible vertex number");
  return static_cast<uint32_t>(index);
}

void ParseFaces(const Element& element, Body& body, TriangleMesh& mesh) {
  int indices = FindProperty(element, "vertex_indices");
  if (indices < 0) indices = FindProperty(element, "vertex_index");
  if (indices < 0 || !element.properties[indices].is_list) Fail("has faces without a list of vertex indices");
  body.RequireAtLeast(element.count);
  mesh.triangles.reserve(element.count);
  for (uint64_t f = 0; f < element.count; ++f) {
    for (size_t column = 0; column < element.properties.size(); ++column) {
      const Property& property = element.properties[column];
      if (static_cast<int>(column) != indices) {
        Skip(body, property);
        continue;
      }
      const uint64_t corners = NextListLength(body, property);
      std::array<uint32_t, 3> fan{};
      for (uint64_t i = 0; i < corners; ++i) {
        fan[std::min<uint64_t>(i, 2)] = NextIndex(body, property.type);
        if (i < 2) continue;
        mesh.triangles.push_back(fan);
        fan[1] = fan[2];
      }
    }
  }
}

}  // namespace

TriangleMesh ParsePly(std::string_view content) {
  const Header header = ParseHeader(content);
  Body body(content, header.format);
  TriangleMesh mesh;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      ParseVertices(element, body, mesh);
    } else if (element.name == "face") {
      ParseFaces(element, body, mesh);
    } else {
      if (!element.properties.empty()) body.RequireAtLeast(element.count);
      for (uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
        for (const Property& property : element.properties) Skip(body, property);
      }
    }
  }
  return mesh;
}

}  // namespace nbs
