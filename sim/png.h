#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace nbs {

/// Colours of a picture, three bytes a pixel (red, green, blue), row by row from the top left.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgb;
};

/// The picture as a PNG file's bytes. Equal pictures give equal bytes.
std::string EncodePng(const Picture& picture);

/// Writes a PNG file.
///
/// @throws ConfigError if the file cannot be written.
void WritePng(const std::filesystem::path& file, const Picture& picture);

}  // namespace nbs
