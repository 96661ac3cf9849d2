// half_state.cpp  States kept as halves: read exactly, rounded to nearest, ties to even, by every target.
#include "baker/research/precision/layer_kernels.hpp"
#include "tests/simd/every_isa.hpp"
#include "tests/simd/test_data.hpp"

using namespace sinew;

namespace {

constexpr uint32_t kNodes = 4096, kPadded = 16;
static_assert(kNodes * kPadded == 65536, "every half once");

// y_keep y + P c of every half y with c zero, as a hidden layer keeps it.
std::vector<uint16_t> kept(float y_keep) {
  std::vector<uint32_t> rows(kNodes + 1, 0);
  test::Floats zero(kNodes * kPadded), halves(kNodes * kPadded / 2), pc(kNodes * kPadded);
  test::Floats tile(simd::tile_floats(kPadded)), w_y(kPadded * 3 * kPadded);
  auto* y = reinterpret_cast<uint16_t*>(halves.data());
  for (uint32_t bits = 0; bits < 65536; ++bits) y[bits] = static_cast<uint16_t>(bits);
  simd::LayerJobOf<baker::Half, baker::Half> job{
      .graph = {rows.data(), nullptr, nullptr}, .inputs = 1, .channels = 16, .padded = kPadded};
  test::Floats h(kNodes * kPadded), c(kNodes * kPadded);
  job.h = reinterpret_cast<baker::Half*>(h.data());
  job.c = reinterpret_cast<baker::Half*>(c.data());
  job.y = y;
  job.y_keep = y_keep;
  job.w_y = w_y.data();
  job.output_gate = zero.data();
  job.pc = pc.data();
  job.tile = tile.data();
  baker::layer_kernels().front()->hidden.output(job, 0, kNodes);
  return {y, y + kNodes * kPadded};
}

// The nearest multiple of a half's spacing, by arithmetic in double.
double nearest_half(float value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double spacing = std::ldexp(1.0, std::max(std::ilogb(value), -14) - 10);
  const double rounded = std::nearbyint(value / spacing) * spacing;
  return std::fabs(rounded) > 65504 ? std::copysign(HUGE_VAL, value) : rounded;
}

}  // namespace

TEST_CASE("states_kept_as_halves_are_rounded_to_nearest_on_every_target") {
  test::for_every_isa([&](const char*, const simd::Kernels&) {
    for (const float keep : {1.0f, 0.8f, 0.37f, 0x1.ffcp-2f, 1.75f}) {
      const std::vector<uint16_t> have = kept(keep);
      for (uint32_t bits = 0; bits < 65536; ++bits) {
        const float before = baker::half_to_float(static_cast<uint16_t>(bits));
        const double want = nearest_half(keep * before), value = baker::half_to_float(have[bits]);
        INFO("half " << bits << " times " << keep);
        REQUIRE((value == want || (std::isnan(value) && std::isnan(before))));
      }
    }
  });
}
