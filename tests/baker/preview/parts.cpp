// parts.cpp  What of a pack moves by itself.
#include "baker/preview/parts.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "baker/preview/pack_mesh.hpp"
#include "tests/scenes/soft_block.hpp"

using namespace sinew;
using baker::Part;

namespace {

struct Opened {
  scenes::PackBytes bytes;
  pack::PackView view;
  explicit Opened(const scenes::BlockOptions& options) : bytes(scenes::soft_block(options)) {
    REQUIRE(pack::open_pack(bytes.bytes(), &view).ok());
  }
};

}  // namespace

TEST_CASE("parts_are_the_regions_then_the_rods") {
  const Opened block({.rods = scenes::RodMatter{}});
  const std::vector<Part> parts = baker::parts_of(block.view);
  REQUIRE(parts.size() == 5);
  CHECK((parts[0].name == "left" && parts[1].name == "right"));
  for (size_t p = 0; p < parts.size(); ++p) {
    const Part& part = parts[p];
    INFO(part.name);
    CHECK(part.is_rod == (p >= 2));
    CHECK(part.bones.empty() == (p < 2));
    CHECK(part.frequency_hz > 0);
    CHECK_FALSE(part.vertices.empty());
    CHECK(std::ranges::is_sorted(part.vertices));
    REQUIRE(part.share.size() == part.vertices.size());
    CHECK(std::ranges::all_of(part.share, [](float share) { return share >= 0 && share <= 1; }));
    CHECK(*std::ranges::max_element(part.share) > 0.9f);
  }
  CHECK(parts[0].frequency_hz ==
        Approx(static_cast<double>(block.view.region_modes[0].first_rad_per_s) / (2 * std::numbers::pi)));
  // A bone carries a ring of four at each end; rings of two bones that meet are one or two.
  CHECK(parts[2].bones.size() == 4);
  CHECK((parts[3].bones.size() == 3 && parts[4].bones.size() == 3));
}

TEST_CASE("what_hangs_on_a_rod_is_no_other_rods") {
  const Opened block({.rods = scenes::RodMatter{}});
  const std::vector<Part> parts = baker::parts_of(block.view);
  for (size_t a = 2; a < parts.size(); ++a)
    for (size_t b = 2; b < a; ++b) {
      std::vector<uint32_t> both;
      std::ranges::set_intersection(parts[a].vertices, parts[b].vertices, std::back_inserter(both));
      CHECK(both.empty());
    }
}

TEST_CASE("the_mesh_of_a_pack_is_its_bind_pose") {
  const Opened block(scenes::BlockOptions{});
  const render::Mesh mesh = baker::bind_mesh(block.view);
  CHECK(mesh.positions.size() == block.view.character->vertex_count);
  CHECK(mesh.normals.size() == mesh.positions.size());
  CHECK(mesh.colors.size() == mesh.positions.size());
  CHECK(mesh.triangles.size() == block.view.character->triangle_count);
  CHECK(mesh.positions[5].y() == block.view.positions[16]);
}
