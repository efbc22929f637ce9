#include "sim/png.h"

#include <fstream>
#include <stdexcept>

#include "common/runtime/error.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wshadow"
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace nbs {

std::string EncodePng(const Picture& picture) {
  if (picture.rgb.size() != static_cast<size_t>(picture.width) * picture.height * 3) {
    throw std::invalid_argument("EncodePng: " + std::to_string(picture.rgb.size()) + " bytes do not fill the picture");
  }
  std::string bytes;
  const auto append = [](void* target, void* data, int size) {
    static_cast<std::string*>(target)->append(static_cast<const char*>(data), size);
  };
  stbi_write_png_to_func(append, &bytes, picture.width, picture.height, 3, picture.rgb.data(), picture.width * 3);
  return bytes;
}

void WritePng(const std::filesystem::path& file, const Picture& picture) {
  const std::string bytes = EncodePng(picture);
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw ConfigError("Cannot write " + file.string() + ": check folder, rights and free space.");
}

}  // namespace nbs
