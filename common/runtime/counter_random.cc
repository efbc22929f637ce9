#include "common/runtime/counter_random.h"

#include <cmath>
#include <numbers>

namespace nbs {
namespace {

uint64_t Mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

double ToUniform(uint64_t bits) { return (static_cast<double>(bits >> 12) + 0.5) * 0x1.0p-52; }

}  // namespace

uint64_t CalcRandomBits(std::initializer_list<uint64_t> keys) {
  uint64_t state = 0;
  for (uint64_t key : keys) state = Mix(state ^ Mix(key));
  return state;
}

double CalcUniform(std::initializer_list<uint64_t> keys) { return ToUniform(CalcRandomBits(keys)); }

double CalcGaussian(std::initializer_list<uint64_t> keys) {
  const uint64_t bits = CalcRandomBits(keys);
  const double u = ToUniform(Mix(bits ^ 1));
  const double v = ToUniform(Mix(bits ^ 2));
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * v);
}

}  // namespace nbs
