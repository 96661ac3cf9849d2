// test_golden_output.cpp  A change of structure changes no bit of what the world puts out.
//
// SINEW_RECORD=1 build/release/bin/test_world "the_world_puts_out*" records golden_output.txt anew: in a
// commit of its own that names the scenes and says why they changed.
#include <cinttypes>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "tests/simd/every_isa.hpp"
#include "tests/world/golden_scenes.hpp"

using namespace sinew;
using test::GoldenOutput;

namespace {

constexpr const char* kFile = SINEW_SOURCE_DIR "/tests/world/golden_output.txt";

std::map<std::string, GoldenOutput> read_recorded() {
  std::map<std::string, GoldenOutput> recorded;
  std::ifstream file(kFile);
  std::string line;
  std::getline(file, line);  // the names of the columns
  for (std::string name; file >> name;) {
    GoldenOutput& output = recorded[name];
    file >> std::hex >> output.positions >> output.normals >> output.joints >> output.decisions;
  }
  return recorded;
}

void write_recorded(const std::map<std::string, GoldenOutput>& outputs) {
  std::ofstream file(kFile);
  file << "scene positions normals joints decisions\n" << std::hex;
  for (const test::GoldenScene& scene : test::golden_scenes()) {
    const GoldenOutput& output = outputs.at(scene.name);
    file << scene.name << ' ' << output.positions << ' ' << output.normals << ' ' << output.joints << ' '
         << output.decisions << '\n';
  }
  REQUIRE(file.flush().good());
}

std::map<std::string, GoldenOutput> play_all() {
  std::map<std::string, GoldenOutput> outputs;
  for (const test::GoldenScene& scene : test::golden_scenes()) {
    INFO("scene " << scene.name);
    test::GoldenRecorder recorder;
    scene.play(recorder);
    REQUIRE(outputs.emplace(scene.name, recorder.output()).second);
  }
  return outputs;
}

}  // namespace

// On every instruction set with fused multiply-adds; the others round otherwise.
TEST_CASE("the_world_puts_out_the_recorded_bits_in_every_golden_scene") {
  if (std::getenv("SINEW_RECORD")) {
    REQUIRE(simd::kernels().fused);
    return write_recorded(play_all());
  }
  const std::map<std::string, GoldenOutput> recorded = read_recorded();
  REQUIRE(recorded.size() == test::golden_scenes().size());
  size_t compared = 0;
  test::for_every_isa([&](const char*, const simd::Kernels& kernels) {
    if (!kernels.fused) return;
    ++compared;
    for (const auto& [name, output] : play_all()) {
      INFO("scene " << name);
      REQUIRE(recorded.contains(name));
      const GoldenOutput& expected = recorded.at(name);
      CHECK(output.positions == expected.positions);
      CHECK(output.normals == expected.normals);
      CHECK(output.joints == expected.joints);
      CHECK(output.decisions == expected.decisions);
    }
  });
  if (compared == 0) WARN("skipped: no instruction set here has fused multiply-adds");
}
