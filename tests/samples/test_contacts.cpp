// test_contacts.cpp  sinew-contacts as a user calls it, and a soft block beside a Bullet box.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>

#include "samples/contacts/play.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/run_program.hpp"
#include "tests/scenes/soft_block.hpp"

using namespace sinew;
using Eigen::Vector3d;
using test::TemporaryFolder;

namespace {

// The block's right side, at x = 0.15, comes 3 cm into a box and stays there.
sample::ContactScene beside_a_box() {
  return {.name = "box",
          .title = "Beside a box",
          .boxes = {{Vector3d(0.1, 0.5, 0.5), [](double) { return Vector3d(0.4, 0.3, 0); }}},
          .root =
              [](double t_s) {
                RootTransform root;
                root.position_m[0] = std::min(0.18, 0.5 * t_s);
                return root;
              },
          .seconds = 11,
          .moments_s = {0.5},
          .rest_from_s = 10,
          .view = {}};
}

// An arm comes 3 cm into the block's right side and stays there.
sample::ContactScene an_arm_beside() {
  return {.name = "arm",
          .title = "An arm",
          .boxes = {},
          .root = [](double) { return RootTransform{}; },
          .pose =
              [](const demo::CharacterFile&, double t_s, std::span<Matrix34> joints) {
                joints.back().m[0][3] -= static_cast<float>(std::min(0.13, 0.5 * t_s));
              },
          .limbs = {"arm_"},
          .seconds = 11,
          .moments_s = {0.5, 0.5},
          .rest_from_s = 10,
          .view = {}};
}

std::string block_file(const TemporaryFolder& folder, const scenes::BlockOptions& options = {}) {
  const scenes::PackBytes pack = scenes::soft_block(options);
  const std::string path = folder.file("block.sinew");
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(pack.bytes().data()),
             static_cast<std::streamsize>(pack.bytes().size()));
  return path;
}

}  // namespace

TEST_CASE("contacts_refuse_what_they_cannot_do") {
  TemporaryFolder folder;
  const std::string out = folder.file("out");
  const std::vector<std::vector<std::string>> bad = {{},
                                                     {folder.file("none.sinew"), "-o", out},
                                                     {folder.path(), "-o", out},
                                                     {block_file(folder), "-o", out, "--width", "0"},
                                                     {block_file(folder), "-o", "/dev/null/out"}};
  for (std::vector<std::string> arguments : bad) {
    arguments.insert(arguments.begin(), SINEW_CONTACTS);
    const test::ProgramResult result = test::run_program(arguments);
    INFO(result.error);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.error, Catch::StartsWith("sinew-contacts: "));
  }
  CHECK(folder.entries() == 1);
}

TEST_CASE("boxes_tell_how_deep_a_point_is_where_they_are") {
  sample::Boxes boxes({{Vector3d(1, 2, 3), [](double t_s) { return Vector3d(t_s, 0, 0); }}});
  CHECK(boxes.depth_m({0, 0, 0}) == 1);
  CHECK(boxes.depth_m({0.75, 0, 0}) == 0.25);
  CHECK(boxes.depth_m({1.5, 0, 0}) == 0);
  boxes.move_to(2, 0.1);
  CHECK(boxes.depth_m({0.75, 0, 0}) == 0);
  CHECK(boxes.depth_m({2, -1.5, 0}) == 0.5);
}

TEST_CASE("edges_of_boxes_lie_in_their_boxes_and_leave_them_open") {
  const Vector3d half(1, 2, 3);
  const sample::Boxes boxes({{half, [](double) { return Vector3d(0, 0, 0); }}});
  render::Mesh mesh;
  boxes.add_edges_to(&mesh);
  CHECK(mesh.triangles.size() == 12 * 12);
  for (const Eigen::Vector3f& place : mesh.positions) {
    const Vector3d inside = half - place.cast<double>().cwiseAbs();
    CHECK(inside.minCoeff() > -1e-6);
    CHECK((inside.array() < 0.01).count() >= 2);
  }
}

TEST_CASE("a_soft_block_is_held_off_its_own_arm_and_stands_still") {
  TemporaryFolder folder;
  const demo::CharacterFile block = demo::open_character(block_file(folder, {.arms = scenes::ArmMatter{}}));
  const sample::ContactPlay play = sample::play(block, an_arm_beside());
  CHECK(play.measured.deepest_alone_mm > 29);
  CHECK(play.measured.deepest_mm < 0.001);
  CHECK(play.measured.jitter_rms_mm < 0.001);
  CHECK(play.measured.vertices_most > 5);
  REQUIRE(play.moments.size() == 2);
  for (const sample::ContactMoment& moment : play.moments) {
    CHECK(std::ranges::max(moment.alone.depths_m) > 0.029f);
    CHECK(std::ranges::max(moment.touching.depths_m) < 1e-6f);
  }
}

TEST_CASE("a_soft_block_beside_a_bullet_box_is_held_off_it_and_stands_still") {
  TemporaryFolder folder;
  const demo::CharacterFile block = demo::open_character(block_file(folder));
  const sample::ContactMeasured measured = sample::play(block, beside_a_box()).measured;
  CHECK(measured.deepest_alone_mm > 29);
  // Places of some tenths of a metre in floats, Bullet's too; the aim for trembling is 0.01 mm.
  CHECK(measured.deepest_mm < 0.001);
  CHECK(measured.jitter_rms_mm < 0.001);
  CHECK(measured.vertices_most > 10);
  CHECK(measured.dropped + measured.refused == 0);
}
