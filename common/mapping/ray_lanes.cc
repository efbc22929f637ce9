#include "common/mapping/ray_lanes.h"

#include <immintrin.h>

namespace nbs::lanes {
namespace {

constexpr double kRayTicks = 1073741824.0;  // 2^30, as in ray_walk.cc
constexpr double kMaxDeltaTicks = kRayTicks + 1.0;
constexpr double kHalfRange = 2147483648.0;  // 2^31
constexpr double kMaxCells = 1e9;
constexpr int32_t kNever = 2147483647;  // The last tick of all, less 2^31.
constexpr int32_t kHighestValue = 0xfffd;
constexpr int32_t kGoal = 0xfffe;

/// When the rays of a group begin and end.
struct Span {
  int32_t last_start;
  int32_t last_end;
};

/// First and last step of each ray of a group, counted from the first step of all; a ray of no cells ends at -1.
[[gnu::always_inline]] inline Span Align(const RayArrays& rays, size_t at, size_t width, int32_t* start, int32_t* end) {
  int32_t first = kNever;
  for (size_t i = 0; i < width; ++i) {
    if (rays.steps[at + i] >= 0 && rays.phase[at + i] < first) first = rays.phase[at + i];
  }
  Span span = {0, -1};
  for (size_t i = 0; i < width; ++i) {
    const bool empty = rays.steps[at + i] < 0;
    start[i] = empty ? 0 : rays.phase[at + i] - first;
    end[i] = empty ? -1 : start[i] + rays.steps[at + i];
    span.last_start = start[i] > span.last_start ? start[i] : span.last_start;
    span.last_end = end[i] > span.last_end ? end[i] : span.last_end;
  }
  return span;
}

/// For each set of kept lanes the order that brings them to the front: lane numbers, one byte each.
template <size_t kLanes>
struct PackTable {
  uint8_t lane[size_t{1} << kLanes][kLanes] = {};
  constexpr PackTable() {
    for (size_t bits = 0; bits < size_t{1} << kLanes; ++bits) {
      size_t kept = 0;
      for (size_t i = 0; i < kLanes; ++i) {
        if ((bits >> i & 1) != 0) lane[bits][kept++] = static_cast<uint8_t>(i);
      }
    }
  }
};

namespace sse42 {
#define NBS_LANES [[gnu::target("sse4.2")]]
constexpr size_t kWidth = 4;
constexpr size_t kDoubles = 2;
using Doubles [[gnu::vector_size(16)]] = double;
using Choice [[gnu::vector_size(16)]] = int64_t;
using Wholes [[gnu::vector_size(8)]] = int32_t;
using Vec = __m128i;
using Mask = __m128i;
/// Shuffles of bytes.
struct ByteTable {
  alignas(16) uint8_t byte[16][16] = {};
  constexpr ByteTable() {
    constexpr PackTable<4> kPack;
    for (size_t bits = 0; bits < 16; ++bits) {
      for (size_t i = 0; i < 16; ++i) byte[bits][i] = static_cast<uint8_t>(4 * kPack.lane[bits][i / 4] + i % 4);
    }
  }
};
constexpr ByteTable kBytes;

NBS_LANES [[gnu::always_inline]] inline Doubles Floor(Doubles x) { return _mm_floor_pd(x); }
NBS_LANES [[gnu::always_inline]] inline Vec Load(const int32_t* from) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
}
NBS_LANES [[gnu::always_inline]] inline Vec Set1(int32_t x) { return _mm_set1_epi32(x); }
NBS_LANES [[gnu::always_inline]] inline Mask Less(Vec a, Vec b) { return _mm_cmpgt_epi32(b, a); }
NBS_LANES [[gnu::always_inline]] inline Mask Equal(Vec a, Vec b) { return _mm_cmpeq_epi32(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask And(Mask a, Mask b) { return _mm_and_si128(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Or(Mask a, Mask b) { return _mm_or_si128(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask AndNot(Mask a, Mask b) { return _mm_andnot_si128(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Not(Mask a) { return _mm_xor_si128(a, _mm_set1_epi32(-1)); }
NBS_LANES [[gnu::always_inline]] inline uint32_t Bits(Mask a) {
  return static_cast<uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(a)));
}
NBS_LANES [[gnu::always_inline]] inline Vec MaskedAdd(Vec a, Vec b, Mask m) {
  return _mm_add_epi32(a, _mm_and_si128(b, m));
}
NBS_LANES [[gnu::always_inline]] inline Mask EqualsLeft(Vec a) { return _mm_cmpeq_epi32(a, _mm_slli_si128(a, 4)); }
NBS_LANES [[gnu::always_inline]] inline void StoreSome(uint32_t* to, Vec a, uint32_t bits) {
  const __m128i order = _mm_load_si128(reinterpret_cast<const __m128i*>(kBytes.byte[bits]));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_shuffle_epi8(a, order));
}
NBS_LANES [[gnu::always_inline]] inline Vec Gather(const uint16_t* from, Vec index, Mask m) {
  alignas(16) int32_t at[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(at), index);
  return _mm_and_si128(_mm_set_epi32(from[at[3]], from[at[2]], from[at[1]], from[at[0]]), m);
}
NBS_LANES [[gnu::always_inline]] inline uint64_t AddLanes(Vec a) {
  alignas(16) uint32_t lane[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(lane), a);
  return uint64_t{lane[0]} + lane[1] + lane[2] + lane[3];
}
#include "common/mapping/ray_lanes.inc"
#undef NBS_LANES
}  // namespace sse42

namespace avx2 {
#define NBS_LANES [[gnu::target("avx2")]]
constexpr size_t kWidth = 8;
constexpr size_t kDoubles = 4;
using Doubles [[gnu::vector_size(32)]] = double;
using Choice [[gnu::vector_size(32)]] = int64_t;
using Wholes [[gnu::vector_size(16)]] = int32_t;
using Vec = __m256i;
using Mask = __m256i;
constexpr PackTable<8> kPack;

NBS_LANES [[gnu::always_inline]] inline Doubles Floor(Doubles x) { return _mm256_floor_pd(x); }
NBS_LANES [[gnu::always_inline]] inline Vec Load(const int32_t* from) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
}
NBS_LANES [[gnu::always_inline]] inline Vec Set1(int32_t x) { return _mm256_set1_epi32(x); }
NBS_LANES [[gnu::always_inline]] inline Mask Less(Vec a, Vec b) { return _mm256_cmpgt_epi32(b, a); }
NBS_LANES [[gnu::always_inline]] inline Mask Equal(Vec a, Vec b) { return _mm256_cmpeq_epi32(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask And(Mask a, Mask b) { return _mm256_and_si256(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Or(Mask a, Mask b) { return _mm256_or_si256(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask AndNot(Mask a, Mask b) { return _mm256_andnot_si256(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Not(Mask a) { return _mm256_xor_si256(a, _mm256_set1_epi32(-1)); }
NBS_LANES [[gnu::always_inline]] inline uint32_t Bits(Mask a) {
  return static_cast<uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(a)));
}
NBS_LANES [[gnu::always_inline]] inline Vec MaskedAdd(Vec a, Vec b, Mask m) {
  return _mm256_add_epi32(a, _mm256_and_si256(b, m));
}
NBS_LANES [[gnu::always_inline]] inline Mask EqualsLeft(Vec a) {
  const Vec left = _mm256_permutevar8x32_epi32(a, _mm256_setr_epi32(0, 0, 1, 2, 3, 4, 5, 6));
  return _mm256_cmpeq_epi32(a, left);
}
NBS_LANES [[gnu::always_inline]] inline void StoreSome(uint32_t* to, Vec a, uint32_t bits) {
  const __m128i order = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(kPack.lane[bits]));
  const Vec packed = _mm256_permutevar8x32_epi32(a, _mm256_cvtepu8_epi32(order));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), packed);
}
NBS_LANES [[gnu::always_inline]] inline Vec Gather(const uint16_t* from, Vec index, Mask m) {
  const Vec pairs = _mm256_mask_i32gather_epi32(Set1(0), reinterpret_cast<const int*>(from), index, m, 2);
  return _mm256_and_si256(pairs, Set1(0xffff));
}
NBS_LANES [[gnu::always_inline]] inline uint64_t AddLanes(Vec a) {
  alignas(32) uint32_t lane[8];
  _mm256_store_si256(reinterpret_cast<__m256i*>(lane), a);
  uint64_t sum = 0;
  for (const uint32_t x : lane) sum += x;
  return sum;
}
#include "common/mapping/ray_lanes.inc"
#undef NBS_LANES
}  // namespace avx2

namespace avx512 {
#define NBS_LANES [[gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]]
constexpr size_t kWidth = 16;
constexpr size_t kDoubles = 8;
using Doubles [[gnu::vector_size(64)]] = double;
using Choice [[gnu::vector_size(64)]] = int64_t;
using Wholes [[gnu::vector_size(32)]] = int32_t;
using Vec = __m512i;
using Mask = __mmask16;

NBS_LANES [[gnu::always_inline]] inline Doubles Floor(Doubles x) {
  return _mm512_maskz_roundscale_pd(0xff, x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
}
NBS_LANES [[gnu::always_inline]] inline Vec Load(const int32_t* from) { return _mm512_loadu_si512(from); }
NBS_LANES [[gnu::always_inline]] inline Vec Set1(int32_t x) { return _mm512_set1_epi32(x); }
NBS_LANES [[gnu::always_inline]] inline Mask Less(Vec a, Vec b) { return _mm512_cmplt_epi32_mask(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Equal(Vec a, Vec b) { return _mm512_cmpeq_epi32_mask(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask And(Mask a, Mask b) { return _kand_mask16(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Or(Mask a, Mask b) { return _kor_mask16(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask AndNot(Mask a, Mask b) { return _kandn_mask16(a, b); }
NBS_LANES [[gnu::always_inline]] inline Mask Not(Mask a) { return _knot_mask16(a); }
NBS_LANES [[gnu::always_inline]] inline uint32_t Bits(Mask a) { return _cvtmask16_u32(a); }
NBS_LANES [[gnu::always_inline]] inline Vec MaskedAdd(Vec a, Vec b, Mask m) {
  return _mm512_mask_add_epi32(a, m, a, b);
}
NBS_LANES [[gnu::always_inline]] inline Mask EqualsLeft(Vec a) {
  return _mm512_cmpeq_epi32_mask(a, _mm512_maskz_alignr_epi32(0xffff, a, a, 15));
}
NBS_LANES [[gnu::always_inline]] inline void StoreSome(uint32_t* to, Vec a, uint32_t bits) {
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), a));
}
NBS_LANES [[gnu::always_inline]] inline Vec Gather(const uint16_t* from, Vec index, Mask m) {
  return _mm512_and_si512(_mm512_mask_i32gather_epi32(Set1(0), m, index, from, 2), Set1(0xffff));
}
NBS_LANES [[gnu::always_inline]] inline uint64_t AddLanes(Vec a) {
  alignas(64) uint32_t lane[16];
  _mm512_store_si512(lane, a);
  uint64_t sum = 0;
  for (const uint32_t x : lane) sum += x;
  return sum;
}
#include "common/mapping/ray_lanes.inc"
#undef NBS_LANES
}  // namespace avx512

}  // namespace

const Kernels kSse42Kernels = sse42::kKernels;
const Kernels kAvx2Kernels = avx2::kKernels;
const Kernels kAvx512Kernels = avx512::kKernels;

}  // namespace nbs::lanes
