// vectors-inl.hpp  The vectors that every kernel is written in.
//
// As all of *-inl.hpp, included by kernels.cpp alone, once a target: no include guard.
HWY_BEFORE_NAMESPACE();
namespace sinew::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Never wider than a block, so that padded rows are whole vectors on every target.
using Floats = hn::CappedTag<float, kBlock>;
using Vector = hn::Vec<Floats>;
inline constexpr size_t kLanes = hn::MaxLanes(Floats());

// Vectors of one row kept in registers by a kernel that holds kTileRows rows: 24 sums need 32 registers, 12
// fit into 16.
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL || HWY_TARGET == HWY_NEON
inline constexpr size_t kWide = 4;
#else
inline constexpr size_t kWide = 2;
#endif

// Runs body.operator()<vectors>(first column) over `columns`, a multiple of kBlock, in the widest steps that
// fit.
template <class Body>
HWY_INLINE void for_columns(size_t columns, const Body& body) {
  size_t j = 0;
  for (; j + kWide * kLanes <= columns; j += kWide * kLanes) body.template operator()<kWide>(j);
  if constexpr (kWide > 2) {
    if (columns - j == 3 * kLanes) return body.template operator()<3>(j);
    for (; j + 2 * kLanes <= columns; j += 2 * kLanes) body.template operator()<2>(j);
  }
  for (; j < columns; j += kLanes) body.template operator()<1>(j);
}

}  // namespace sinew::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
