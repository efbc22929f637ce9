#pragma once

#include <string>

namespace nbs {

/// A picture for the report: a PNG file's bytes, and what is drawn over it.
struct ReportPicture {
  std::string caption;
  std::string png;
  int width = 0;  ///< Pixels.
  int height = 0;
  std::string overlay;  ///< SVG elements, in pixels from the upper left corner.
};

}  // namespace nbs
