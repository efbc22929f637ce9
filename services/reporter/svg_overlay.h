#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace nbs {

/// Points in a picture, pixels.
using PixelLine = std::vector<Eigen::Vector2d>;

/// CSS colour of scan `number` of `count`, from 0: from teal over blue to magenta, dark enough for white letters.
std::string MakeScanColor(int number, int count);

/// A line in a colour with a white edge. One of less than two points gives nothing.
std::string DrawLine(const PixelLine& line, const std::string& color, double width);

/// A filled shape that lets half of what lies behind it through.
std::string DrawArea(const PixelLine& outline, const std::string& color);

/// Numbers in discs, so placed that none covers another where that can be avoided.
class NumberDiscs {
 public:
  /// A number beside a line: at that of its points which is farthest from all numbers so far, the first of equals.
  void Add(int number, const PixelLine& line, const std::string& color);

  std::string Draw() const;

 private:
  struct Disc {
    int number;
    Eigen::Vector2d at;
    std::string color;
  };
  std::vector<Disc> discs_;
};

}  // namespace nbs
