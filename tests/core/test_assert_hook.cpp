// test_assert_hook.cpp  A programmer error reaches the hook with its place.
#include <catch2/catch.hpp>
#include <string>

#include "core/assert_hook.hpp"

namespace {

struct Seen {
  std::string condition, file;
  int line = 0;
};

}  // namespace

TEST_CASE("assert_hook_hears_what_and_where") {
  Seen seen;
  const auto fail = [](const char* condition, const char* file, int line, void* context) {
    *static_cast<Seen*>(context) = {condition, file, line};
  };
  const int line = __LINE__ + 1;
  sinew::core::report_fault({.fail = fail, .context = &seen}, "the id is stale");
  CHECK(seen.condition == "the id is stale");
  CHECK(seen.file.find("test_assert_hook.cpp") != std::string::npos);
  CHECK(seen.line == line);
}
