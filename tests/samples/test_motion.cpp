// test_motion.cpp  What moves the demo's characters.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "baker/common/bad_input.hpp"
#include "samples/demo/motion.hpp"
#include "samples/demo/pose_blend.hpp"
#include "tests/baker/common/temporary_folder.hpp"
#include "tests/pack/small_pack.hpp"
#include "tests/scenes/soft_block.hpp"

using namespace sinew;
using namespace sinew::demo;
using sinew::test::TemporaryFolder;

namespace {

void write_bytes(const std::string& path, std::span<const std::byte> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
}

CharacterFile with_clip(const TemporaryFolder& folder) {
  write_bytes(folder.file("clip.sinew"), test::small_character_pack());
  return open_character(folder.file("clip.sinew"));
}

CharacterFile without_clip(const TemporaryFolder& folder) {
  write_bytes(folder.file("block.sinew"), scenes::soft_block().bytes());
  return open_character(folder.file("block.sinew"));
}

// The farthest that any joint's origin moves between two times; the root's way counts.
double way_m(const Motion& motion, size_t joints, double from_s, double to_s) {
  std::vector<Matrix34> a(joints), b(joints);
  RootTransform root_a, root_b;
  motion.pose_at(from_s, a, &root_a);
  motion.pose_at(to_s, b, &root_b);
  double farthest = 0;
  for (size_t j = 0; j < joints; ++j) {
    double sum2 = 0;
    for (int i = 0; i < 3; ++i) {
      const double way =
          double(b[j].m[i][3]) - double(a[j].m[i][3]) + root_b.position_m[i] - root_a.position_m[i];
      sum2 += way * way;
    }
    farthest = std::max(farthest, std::sqrt(sum2));
  }
  return farthest;
}

// Entries of joint matrices that differ by more than this differ.
double largest_difference(const std::vector<Matrix34>& a, const std::vector<Matrix34>& b) {
  double largest = 0;
  for (size_t j = 0; j < a.size(); ++j) {
    for (int e = 0; e < 12; ++e)
      largest = std::max(largest, std::abs(double((&a[j].m[0][0])[e]) - double((&b[j].m[0][0])[e])));
  }
  return largest;
}

Matrix34 turned(float angle_rad, float x, float y) {
  const float c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {{{c, -s, 0, x}, {s, c, 0, y}, {0, 0, 1, 0}}};
}

}  // namespace

TEST_CASE("files_that_are_no_characters_are_refused_by_name") {
  TemporaryFolder folder;
  write_bytes(folder.file("model.sinew"), test::small_model());
  CHECK_THROWS_WITH(open_character(folder.file("model.sinew")),
                    Catch::Contains("model.sinew") && Catch::Contains("sinew-bake character"));
  CHECK_THROWS_WITH(open_character(folder.file("none.sinew")), Catch::Contains("none.sinew"));
  std::vector<std::byte> bytes = test::small_character_pack();
  bytes.resize(bytes.size() / 2);
  write_bytes(folder.file("half.sinew"), bytes);
  CHECK_THROWS_WITH(open_character(folder.file("half.sinew")), Catch::Contains("half.sinew"));
}

TEST_CASE("clip_that_is_not_there_is_refused_with_those_that_are") {
  TemporaryFolder folder;
  const CharacterFile character = with_clip(folder);
  CHECK_THROWS_WITH(make_motion(character, "moonwalk"),
                    Catch::Contains("moonwalk") && Catch::Contains(character.clip_name(0)));
  const CharacterFile block = without_clip(folder);
  CHECK_THROWS_WITH(make_motion(block, "hop"), Catch::Contains("it has none"));
}

TEST_CASE("motions_start_from_rest_and_move_later") {
  TemporaryFolder folder;
  const CharacterFile clip = with_clip(folder), block = without_clip(folder);
  for (const CharacterFile* character : {&clip, &block}) {
    const auto motion = make_motion(*character, "");
    const size_t joints = character->view.joints.size();
    double farthest = 0;
    for (double t = 0; t < 3; t += 0.05) farthest = std::max(farthest, way_m(*motion, joints, 0, t));
    CHECK(farthest > 0.01);
    CHECK(way_m(*motion, joints, 0, 1.0 / 60) < 1e-3 * farthest);
  }
}

TEST_CASE("built_in_shake_is_smooth_and_pauses") {
  TemporaryFolder folder;
  const CharacterFile block = without_clip(folder);
  const auto motion = make_motion(block, "");
  CHECK(motion->name_at(1) == "built-in shake");
  constexpr double kStep_s = 1e-3, kFastest_m_s = 3;  // a block of 0.6 m
  for (double t = 0; t < 9; t += kStep_s) CHECK(way_m(*motion, 2, t, t + kStep_s) < kFastest_m_s * kStep_s);
  const double pause_s = 0.3 + 3.3;  // the start costs 0.3 s; shaking stops after 3.1 s of each four
  CHECK(way_m(*motion, 2, pause_s, pause_s + 0.2) == Approx(0).margin(1e-9));
}

TEST_CASE("mixed_poses_end_on_the_poses_and_keep_the_length_of_limbs") {
  std::vector<pack::JointRecord> joints(3);
  joints[0].parent = pack::kNoIndex;
  joints[1].parent = 0;
  joints[2].parent = 1;
  const std::vector<Matrix34> straight = {turned(0, 0, 0), turned(0, 1, 0), turned(0, 2, 0)};
  const std::vector<Matrix34> bent = {turned(0, 0, 0), turned(1.5f, 1, 0),
                                      turned(1.5f, 1 + std::cos(1.5f), std::sin(1.5f))};
  std::vector<Matrix34> out(3);
  mix_far(joints, straight, bent, 0, out);
  CHECK(largest_difference(out, straight) < 1e-6);
  mix_far(joints, straight, bent, 1, out);
  CHECK(largest_difference(out, bent) < 1e-6);
  mix_far(joints, straight, bent, 0.5f, out);
  CHECK(std::hypot(out[2].m[0][3] - out[1].m[0][3], out[2].m[1][3] - out[1].m[1][3]) ==
        Approx(1).epsilon(1e-5));
  CHECK(largest_difference(out, {turned(0, 0, 0), turned(0.75f, 1, 0),
                                 turned(0.75f, 1 + std::cos(0.75f), std::sin(0.75f))}) < 1e-5);
}
