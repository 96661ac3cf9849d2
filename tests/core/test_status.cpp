// test_status.cpp  A status is one line of bounded length.
#include <catch2/catch.hpp>
#include <string>

#include "core/status.hpp"

using namespace sinew;
using core::make_status;

TEST_CASE("a_message_is_formatted_and_a_long_one_is_cut") {
  const Status status = make_status(StatusCode::kCorrupt, "joint %d of %s", 3, "bar");
  CHECK(status.code == StatusCode::kCorrupt);
  CHECK_FALSE(status.ok());
  CHECK(std::string(status.message) == "joint 3 of bar");
  const std::string longer(1000, 'x');
  CHECK(std::string(make_status(StatusCode::kCorrupt, "%s", longer.c_str()).message) ==
        longer.substr(0, sizeof(Status::message) - 1));
  CHECK(Status{}.ok());
}
