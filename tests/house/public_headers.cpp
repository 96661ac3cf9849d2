// public_headers.cpp  Each public header is included first in a file of its own (see CMakeLists.txt); this
// one has them all.
#include <catch2/catch.hpp>

#include "sinew/sinew.hpp"

TEST_CASE("public_structs_are_plain_data") {
  STATIC_REQUIRE(std::is_trivially_copyable_v<sinew::WorldDef>);
  STATIC_REQUIRE(std::is_trivially_copyable_v<sinew::InstanceDef>);
  STATIC_REQUIRE(std::is_trivially_copyable_v<sinew::FrameReport>);
  STATIC_REQUIRE(std::is_trivially_copyable_v<sinew::Status>);
  STATIC_REQUIRE(std::is_standard_layout_v<sinew::ReadDef>);
}

TEST_CASE("an_id_of_zeros_is_null") {
  REQUIRE(sinew::is_null(sinew::AssetId{}));
  REQUIRE(sinew::is_null(sinew::InstanceId{}));
  REQUIRE_FALSE(sinew::is_null(sinew::InstanceId{1, 1}));
}
