// meshopt_views.cpp  Views that EXT_meshopt_compression packed are read as if they were not.
#include "baker/import/gltf/meshopt_views.hpp"

#include <meshoptimizer.h>

#include <catch2/catch.hpp>

#include "baker/common/bad_input.hpp"
#include "baker/import/import_gltf.hpp"
#include "tiny_file.hpp"

using namespace sinew::baker;

namespace {

const std::vector<float> kPositions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0, 1, 2, 0};

// The bar with its positions packed; a second buffer, of a length but no bytes, stands for them unpacked.
TinyFile packed_bar() {
  TinyFile file = bar();
  std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(6, 12));
  packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), kPositions.data(), 6, 12));
  file.add(packed, "SCALAR", 5121);
  file.json["accessors"].erase(file.json["accessors"].size() - 1);
  const nlohmann::json plain = file.json["bufferViews"].back();
  file.json["bufferViews"].erase(file.json["bufferViews"].size() - 1);
  file.json["bufferViews"][0] = {{"buffer", 1},
                                 {"byteLength", 72},
                                 {"extensions",
                                  {{"EXT_meshopt_compression",
                                    {{"buffer", 0},
                                     {"byteOffset", plain["byteOffset"]},
                                     {"byteLength", packed.size()},
                                     {"byteStride", 12},
                                     {"mode", "ATTRIBUTES"},
                                     {"count", 6}}}}}};
  file.json["buffers"] = {
      {{"byteLength", (file.bytes.size() + 3) / 4 * 4}},
      {{"byteLength", 72}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  file.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  return file;
}

nlohmann::json& extension(TinyFile& file) {
  return file.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
}

void check_refused(const TinyFile& file, const std::string& words) {
  CHECK_THROWS_WITH(import_gltf(file.write("packed_broken")), Catch::Contains(words));
}

}  // namespace

TEST_CASE("packed_views_that_are_damaged_are_refused_by_what_is_wrong") {
  TinyFile file = packed_bar();
  extension(file)["mode"] = "POINTS";
  check_refused(file, "unknown mode 'POINTS'");
  file = packed_bar();
  extension(file)["byteLength"] = 1e6;
  check_refused(file, "past the end of its buffer");
  file = packed_bar();
  extension(file)["count"] = 4e9;
  check_refused(file, "1 GiB");
  file = packed_bar();
  extension(file)["byteStride"] = 7;
  check_refused(file, "byteStride");
  file = packed_bar();
  extension(file)["filter"] = "QUATERNION";
  check_refused(file, "filter 'QUATERNION'");
  file = packed_bar();
  extension(file).erase("count");
  check_refused(file, "its count is not a whole number");
  file = packed_bar();
  file.bytes[file.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteOffset"]
                 .get<size_t>()] = 7;
  check_refused(file, "do not decode");
  file = packed_bar();
  file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  check_refused(file, "compressed by KHR_draco_mesh_compression");
}

TEST_CASE("packed_views_are_decoded_and_a_buffer_without_bytes_is_no_fault") {
  const Character character = import_gltf(packed_bar().write("packed"));
  REQUIRE(character.positions.size() == 6);
  for (size_t v = 0; v < 6; ++v)
    for (int k = 0; k < 3; ++k)
      CHECK(character.positions[v][k] == static_cast<double>(kPositions[3 * v + static_cast<size_t>(k)]));
}
