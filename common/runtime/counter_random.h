#pragma once

#include <cstdint>
#include <initializer_list>

namespace nbs {

/// Counter-based random numbers: a pure function of its keys, so that the value for (seed, scan, stripe, beam) does not
/// depend on what was drawn before it. The keys are mixed one after the other by the finaliser of SplitMix64 (Steele et
/// al., OOPSLA 2014, DOI 10.1145/2660193.2660195).
uint64_t CalcRandomBits(std::initializer_list<uint64_t> keys);

/// Uniform in the open interval (0, 1).
double CalcUniform(std::initializer_list<uint64_t> keys);

/// Normal with mean 0 and standard deviation 1 (Box-Muller on two draws under the keys).
double CalcGaussian(std::initializer_list<uint64_t> keys);

}  // namespace nbs
