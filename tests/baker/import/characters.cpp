// characters.cpp  Real characters: counts as their table says, and animated as a second implementation
// animates them.
#include <catch2/catch.hpp>
#include <filesystem>

#include "baker/import/import_gltf.hpp"
#include "reference_skinning.hpp"

using namespace sinew::baker;

namespace {

// Both sides compute in double; matrices of a dozen levels and f32 inputs leave this much.
constexpr double kRelativeError = 1e-9;

struct Expected {
  const char* file;
  size_t vertices, welded, triangles, joints, clips;
};

// characters/README.md
constexpr Expected kCharacters[] = {
    {"godette_vrm0/file.vrm", 3109, 2002, 3439, 68, 0},
    {"kaykit_mage/file.glb", 5279, 2937, 5683, 41, 76},
    {"khronos_cesium_man/file.glb", 3273, 2338, 4672, 19, 1},
    {"khronos_fox/file.glb", 1728, 290, 576, 24, 3},
    {"khronos_rigged_simple/file.gltf", 160, 96, 188, 2, 1},
    {"mh_heavy_male/file.glb", 13380, 13380, 26756, 55, 3},
    {"quaternius_wolf/file.glb", 3994, 983, 1962, 51, 12},
    {"raylib_greenman/file.glb", 196, 180, 356, 12, 4},
};

bool characters_there() {
  if (std::filesystem::exists(SINEW_SHARED_DIR "/characters")) return true;
  WARN("skipped: no characters in " SINEW_SHARED_DIR "; set SINEW_SHARED_DIR");
  return false;
}

std::string path_of(const Expected& expected) {
  return std::string(SINEW_SHARED_DIR "/characters/") + expected.file;
}

size_t count_welded(const Character& character) {
  size_t count = 0;
  for (size_t v = 0; v < character.welded.size(); ++v)
    count += character.welded[v] == static_cast<int>(v) ? 1u : 0u;
  return count;
}

double largest_difference(const std::vector<Vector3>& a, const std::vector<Eigen::Vector3d>& b) {
  REQUIRE(a.size() == b.size());
  double largest = 0;
  for (size_t v = 0; v < a.size(); ++v) largest = std::max(largest, (a[v] - b[v]).norm());
  return largest;
}

double extent(const std::vector<Eigen::Vector3d>& places) {
  double largest = 0;
  for (const auto& place : places) largest = std::max(largest, place.norm());
  return largest;
}

}  // namespace

TEST_CASE("characters_import_with_the_counts_of_their_table") {
  if (!characters_there()) return;
  for (const Expected& expected : kCharacters) {
    const Character character = import_gltf(path_of(expected));
    INFO(expected.file);
    CHECK(character.positions.size() == expected.vertices);
    CHECK(count_welded(character) == expected.welded);
    CHECK(character.triangles.size() == expected.triangles);
    CHECK(character.joint_node.size() == expected.joints);
    CHECK(character.clips.size() == expected.clips);
  }
}

TEST_CASE("characters_animate_as_a_straightforward_skinning_does") {
  if (!characters_there()) return;
  for (const Expected& expected : kCharacters) {
    const Character character = import_gltf(path_of(expected), {.unit_m = 1});
    const ReferenceFile reference(path_of(expected));
    INFO(expected.file);
    const auto rest = reference.positions(-1, 0);
    CHECK(largest_difference(skin_positions(character, joint_matrices(character, nullptr, 0)), rest) <
          kRelativeError * extent(rest));
    REQUIRE(reference.clip_count() == static_cast<int>(character.clips.size()));
    const int stride =
        character.clips.size() > 20 ? 7 : 1;  // every seventh of 76 clips: the reference is slow
    for (int c = 0; c < reference.clip_count(); c += stride) {
      const Clip& clip = character.clips[static_cast<size_t>(c)];
      CHECK(clip.duration_s == reference.clip_duration(c));
      for (double share : {0.0, 0.137, 0.5, 0.911, 1.2}) {  // the last is beyond the end
        const double t = share * clip.duration_s;
        const auto posed = reference.positions(c, t);
        INFO(clip.name << " at " << t);
        CHECK(largest_difference(skin_positions(character, joint_matrices(character, &clip, t)), posed) <
              kRelativeError * extent(posed));
      }
    }
  }
}

TEST_CASE("a_character_in_centimetres_is_imported_in_metres") {
  if (!characters_there()) return;
  const Character character = import_gltf(SINEW_SHARED_DIR "/characters/khronos_fox/file.glb");
  const ReferenceFile reference(SINEW_SHARED_DIR "/characters/khronos_fox/file.glb");
  auto posed = reference.positions(1, 0.3);
  for (auto& place : posed) place *= 0.01;
  CHECK(largest_difference(skin_positions(character, joint_matrices(character, &character.clips[1], 0.3)),
                           posed) < kRelativeError);
}

TEST_CASE("joints_and_nodes_come_after_their_parents") {
  if (!characters_there()) return;
  for (const Expected& expected : kCharacters) {
    const Character character = import_gltf(path_of(expected));
    INFO(expected.file);
    for (size_t j = 0; j < character.joint_parent.size(); ++j)
      CHECK(character.joint_parent[j] < static_cast<int>(j));
    for (size_t n = 0; n < character.nodes.size(); ++n)
      CHECK(character.nodes[n].parent < static_cast<int>(n));
  }
}
