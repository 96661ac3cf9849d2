// test_rods.cpp  sinew-rods as a user calls it, its tubes, and the wind on its tree.
#include <stb/stb_image.h>

#include <catch2/catch.hpp>

#include "samples/rods/tube.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/baker/programs/run_program.hpp"
#include "tests/rods/rod_scenes.hpp"
#include "tests/scenes/branching_rod.hpp"
#include "tests/scenes/wind.hpp"

using namespace sinew;
using test::ProgramResult;
using test::TemporaryFolder;

namespace {

ProgramResult rods_program(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SINEW_RODS);
  for (const char* small : {"--width", "32", "--height", "32", "--samples", "1"}) arguments.push_back(small);
  return test::run_program(arguments);
}

void check_refused(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  const ProgramResult result = rods_program(arguments);
  INFO(result.error);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.error, Catch::StartsWith("sinew-rods: "));
  CHECK(result.error.find('\n') == result.error.size() - 1);
  for (const std::string& word : words) CHECK_THAT(result.error, Catch::Contains(word));
}

// Pictures on a sheet of that many columns and rows, at 32 pixels, gaps of 8, captions of 24, a title of 44.
void check_sheet(const std::string& path, int columns, int rows) {
  int width = 0, height = 0, channels = 0;
  uint8_t* pixels = stbi_load(path.c_str(), &width, &height, &channels, 3);
  REQUIRE(pixels != nullptr);
  stbi_image_free(pixels);
  CHECK(width == 8 + 40 * columns);
  CHECK(height == 52 + 64 * rows);
}

rods::SegmentPose pose_of(const rods::SegmentDef& s) {
  rods::SegmentPose pose;
  std::copy_n(s.position_m, 3, pose.position_m);
  std::copy_n(s.orientation, 4, pose.orientation);
  return pose;
}

}  // namespace

TEST_CASE("rods_refuses_what_it_cannot_draw") {
  TemporaryFolder folder;
  check_refused({}, {"--output"});
  check_refused({"-o", folder.file("out"), "--scene", "castle"},
                {"castle", "there are tree, helix, two_rods"});
  check_refused({"-o", folder.file("out"), "--seconds", "0"}, {"--seconds"});
  check_refused({"-o", folder.file("out"), "--seconds", "nan"}, {"--seconds", "nan"});
  check_refused({"-o", "/dev/null/out"}, {"/dev/null/out"});
  CHECK(folder.entries() == 0);
}

TEST_CASE("rods_draws_a_tree_of_more_than_a_thousand_segments_in_wind") {
  TemporaryFolder folder;
  const ProgramResult result =
      rods_program({"-o", folder.file("out"), "--scene", "tree", "--seconds", "0.5"});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("1 x 1211 segments, 30 steps"));
  CHECK_THAT(result.out, Catch::Contains(" 0 not converged"));
  check_sheet(folder.file("out/tree.png"), 3, 2);
}

TEST_CASE("rods_draws_a_helix_on_a_plane_and_two_rods_that_touch") {
  TemporaryFolder folder;
  const ProgramResult result =
      rods_program({"-o", folder.file("out"), "--scene", "helix", "--scene", "two_rods", "--seconds", "0.6"});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("1 x 120 segments, 72 steps"));
  CHECK_THAT(result.out, Catch::Contains("2 x 50 segments, 72 steps"));
  const size_t first = result.out.find(" contacts, ");
  REQUIRE(first != std::string::npos);
  CHECK(result.out.find(" contacts, ", first + 1) != std::string::npos);
  check_sheet(folder.file("out/helix.png"), 3, 2);
  check_sheet(folder.file("out/two_rods.png"), 3, 2);
}

#ifdef SINEW_HAS_BULLET
TEST_CASE("rods_draws_a_rope_on_a_drum_that_it_does_not_sink_into") {
  TemporaryFolder folder;
  const ProgramResult result =
      rods_program({"-o", folder.file("out"), "--scene", "drum", "--seconds", "0.5"});
  INFO(result.error);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.out, Catch::Contains("1 x 108 segments, 60 steps"));
  CHECK_THAT(result.out, Catch::Contains(" contacts, 0.0") && Catch::Contains(" by contacts, 0.0"));
  check_sheet(folder.file("out/drum.png"), 3, 2);
}
#endif

TEST_CASE("a_tube_is_as_thick_as_its_rod_everywhere_and_closed") {
  sample::Actor actor{test::straight_rod({.segments = 5, .length_m = 1}), {{1, 0, 0}, {0, 1, 0}, 12, 3}, {}};
  sample::Poses poses;
  for (const rods::SegmentDef& s : actor.segments) poses.push_back(pose_of(s));
  render::Mesh mesh;
  sample::add_tube(actor, poses, &mesh);
  const float radius = actor.segments[0].radius_m;
  for (const Eigen::Vector3f& p : mesh.positions) {
    const float from_axis = std::hypot(p.y(), p.z());
    CHECK(from_axis < 1.0001f * radius);
    CHECK(p.x() > -1.01f * radius);
    CHECK(p.x() < 1 + 1.01f * radius);
    if (p.x() > 0.01f && p.x() < 0.99f) CHECK(from_axis == Approx(radius).epsilon(1e-3));
  }
  for (const Eigen::Vector3f& n : mesh.normals) CHECK(n.norm() == Approx(1).epsilon(1e-4));
  // Closed and turned outwards or inwards alike: the triangles enclose the capsule's volume.
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += static_cast<double>(mesh.positions[a].cross(mesh.positions[b]).dot(mesh.positions[c])) / 6;
  }
  const double r = static_cast<double>(radius), cylinder = M_PI * r * r;
  // Twelve sides enclose 0.955 of a circle, and the root's end is flatter than a ball.
  CHECK(std::fabs(volume) > 0.94 * cylinder);
  CHECK(std::fabs(volume) < cylinder * (1 + 4 * r / 3));
}

TEST_CASE("wind_along_a_segment_does_nothing_and_across_it_pushes_downwind") {
  const rods::SegmentDef s = test::straight_rod({.segments = 2})[0];  // along x
  const rods::SegmentPose pose = pose_of(s);
  CHECK(test::drag_n(s, 0.1, pose, {}, {9, 0, 0}, 0.01).norm() < 1e-5);
  const Eigen::Vector3d force = test::drag_n(s, 0.1, pose, {}, {9, 0, 3}, 1e-9);
  // rho / 2 c w l |u|^2 = 0.6 * 1.1 * 0.1 * 2 * 9
  CHECK(force.z() == Approx(1.188).epsilon(1e-5));
  CHECK(std::fabs(force.x()) + std::fabs(force.y()) < 1e-6);
}

TEST_CASE("drag_never_makes_a_twig_faster_than_the_air") {
  rods::SegmentDef twig = test::straight_rod({.segments = 2, .length_m = 0.1, .radius_m = 0.0005f})[1];
  twig.density_kg_m3 = 10;
  const double mass = rods::segment_inertia(twig).mass_kg, dt = 0.1;
  const Eigen::Vector3d force = test::drag_n(twig, 0.3, pose_of(twig), {}, {0, 0, 20}, dt);
  CHECK(dt * force.z() / mass < 20);
  CHECK(dt * force.z() / mass > 19);
}

TEST_CASE("trees_have_the_segments_their_rule_says_and_are_accepted") {
  CHECK(test::TreeGrower(test::kYoungTree, {}).grow().segments.size() == 1211);
  for (const uint32_t count : {4u, 10u, 30u, 49u, 50u, 100u, 200u}) {
    const std::vector<rods::SegmentDef> tree = test::forked_rod(count, 1e6);
    CHECK(tree.size() == count);
    test::RodBatch batch;
    const Status status = test::try_batch({tree}, {}, &batch);
    INFO(status.message);
    CHECK(status.ok());
  }
}
