// every_isa.hpp  Runs a check on each instruction set of this machine, and compares bits between those with
// FMA.
#pragma once
#include <catch2/catch.hpp>
#include <cstring>
#include <string>
#include <vector>

#include "simd/isa.hpp"
#include "simd/kernels.hpp"

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

// produce(kernels) gives floats; all tables with FMA must give the same bits.
template <class Produce>
void require_same_bits_where_fused(const Produce& produce) {
  std::vector<float> first;
  for_every_isa([&](const char*, const simd::Kernels& kernels) {
    if (!kernels.fused) return;
    const std::vector<float> values = produce(kernels);
    if (first.empty()) first = values;
    REQUIRE(values.size() == first.size());
    REQUIRE(std::memcmp(values.data(), first.data(), values.size() * sizeof(float)) == 0);
  });
}

}  // namespace sinew::test
