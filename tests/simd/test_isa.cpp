// test_isa.cpp  One table is chosen at start; names that are not there change nothing.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <string>

#include "kernels/isa.hpp"
#include "kernels/kernels.hpp"

using namespace sinew;

namespace {

// One line: which, and what there is instead.
void check_refused(const Status& status, const char* name) {
  REQUIRE(status.code == StatusCode::kUnsupported);
  CHECK(std::strstr(status.message, name) != nullptr);
  CHECK(std::strchr(status.message, '\n') == nullptr);
  for (const char* available : simd::available_isas()) {
    CHECK(std::strstr(status.message, available) != nullptr);
  }
}

}  // namespace

TEST_CASE("force_isa_refuses_what_is_not_there_and_changes_nothing") {
  const std::string before = simd::active_isa();
#if defined(__aarch64__)
  const char* const of_another_processor = "avx2";
#else
  const char* const of_another_processor = "neon";
#endif
  for (const char* name : {"", "AVX2", "avx1024", of_another_processor}) {
    check_refused(simd::force_isa(name), name);
    REQUIRE(simd::active_isa() == before);
  }
  check_refused(simd::force_isa(nullptr), "(null)");
}

TEST_CASE("every_available_isa_can_be_forced_and_names_are_lower_case_and_different") {
  const auto names = simd::available_isas();
  REQUIRE(!names.empty());
  const std::string before = simd::active_isa();
  for (size_t i = 0; i < names.size(); ++i) {
    REQUIRE(simd::force_isa(names[i]).ok());
    REQUIRE(std::string(simd::active_isa()) == names[i]);
    REQUIRE(std::none_of(names[i], names[i] + std::strlen(names[i]), [](char c) { return std::isupper(c); }));
    for (size_t k = 0; k < i; ++k) REQUIRE(std::string(names[i]) != names[k]);
  }
  REQUIRE(simd::force_isa(before.c_str()).ok());
}

// The next three run in processes of their own, with SINEW_ISA set by CMakeLists.txt.
TEST_CASE("missing_isa_in_the_environment_is_refused_by_name_and_the_best_is_used", "[.]") {
  const char* wanted = std::getenv("SINEW_ISA");
  REQUIRE(wanted != nullptr);
  check_refused(simd::check_environment(), wanted);
  CHECK(std::strstr(simd::check_environment().message, "SINEW_ISA") != nullptr);
  REQUIRE(std::string(simd::active_isa()) == simd::available_isas().front());
}

TEST_CASE("empty_isa_in_the_environment_counts_as_none", "[.]") {
  REQUIRE(std::getenv("SINEW_ISA") != nullptr);
  REQUIRE(simd::check_environment().ok());
  REQUIRE(std::string(simd::active_isa()) == simd::available_isas().front());
}

TEST_CASE("isa_in_the_environment_is_the_active_one", "[.]") {
  const char* wanted = std::getenv("SINEW_ISA");
  REQUIRE(wanted != nullptr);
  const auto names = simd::available_isas();
  const bool there =
      std::any_of(names.begin(), names.end(), [&](const char* name) { return !std::strcmp(name, wanted); });
  if (!there) WARN("skipped: " << wanted << " is not available on this machine: nothing to check");
  REQUIRE((std::string(simd::active_isa()) == wanted) == there);
  REQUIRE(simd::check_environment().ok() == there);
}
