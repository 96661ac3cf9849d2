// every_isa.hpp  Runs a check on each instruction set of this machine, and compares bits between those with
// FMA, on this and on other processors.
#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/hash.hpp"
#include "kernels/isa.hpp"
#include "kernels/kernels.hpp"

namespace sinew::test {

// check(name, kernels) with each table active in turn; afterwards the one that was active before is so again.
template <class Check>
void for_every_isa(const Check& check) {
  const std::string before = simd::active_isa();
  for (const char* name : simd::available_isas()) {
    INFO("instruction set " << name);
    REQUIRE(simd::force_isa(name).ok());
    check(name, simd::kernels());
  }
  REQUIRE(simd::force_isa(before.c_str()).ok());
}

// produce(kernels) gives floats; all tables with FMA, on x86 and on Arm, must give those whose hash64 is
// `recorded`. A change of the arithmetic changes the hash: take over the one that fails here, once x86 and
// SINEW_PRESET=aarch64 show the same.
template <class Produce>
void require_same_bits_where_fused(uint64_t recorded, const Produce& produce) {
  for_every_isa([&](const char*, const simd::Kernels& kernels) {
    if (!kernels.fused) return;
    const std::vector<float> values = produce(kernels);
    CHECK(core::hash64(std::as_bytes(std::span(values))) == recorded);
  });
}

}  // namespace sinew::test
